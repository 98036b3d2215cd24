// Directions: every mixture against its density, the resampled ones against quadrature.

#include "darts/DirectionSampler.h"

#include "support/ChiSquare.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;

tungsten::Vec3f toHost(const Vec3& v) {
    return {v.x, v.y, v.z};
}
Vec3 fromHost(const tungsten::Vec3f& v) {
    return {v.x, v.y, v.z};
}

/// A camera that looks along `axis` into a cone, and a tenth of the time anywhere.
struct ConeView {
    Vec3 axis;
    float h = 0.05f; ///< of the cone's edge

    [[nodiscard]] Vec3 sample(float u, float v) const {
        if (u < 0.1f) return directionAbout(axis, 2.0f * u / 0.1f, v);
        return directionAbout(axis, h * (u - 0.1f) / 0.9f, v);
    }
    [[nodiscard]] float pdf(const Vec3& direction) const {
        const float inside = oneMinusCosine(direction, axis) < h ? 0.9f / (2.0f * Pi * h) : 0.0f;
        return inside + 0.1f / (4.0f * Pi);
    }
};

struct Case {
    float C, excess, g;
    float alpha;
};
const Case Cases[] = {{1.0f, 0.3f, 0.0f, 0.1f},
                      {1.0f, 0.02f, 0.3f, 0.5f},
                      {2.0f, 8.0f, -0.6f, 0.2f},
                      {0.5f, 0.1f, 0.7f, 1.0f},
                      {1e-6f, 1.0f, 0.4f, 0.1f}};
const Vec3 Before = Vec3{0.6f, 0.0f, 0.8f};
const Vec3 ToTarget = Vec3{0.48f, 0.64f, -0.6f};

TEST(HenyeyGreenstein, SamplesItsDensity) {
    for (const float g : {0.0f, 0.3f, 0.8f, -0.7f, 1e-5f}) {
        const HenyeyGreenstein phase{Before, g};
        const double p = tungsten::test::chiSquareSphere(
            [&](Sampler& s) {
                const float u = s.next1D();
                return std::optional(toHost(phase.sample(u, s.next1D())));
            },
            [&](const tungsten::Vec3f& d) { return double(phase.pdf(fromHost(d))); });
        EXPECT_GT(p, tungsten::test::SmallestPValue) << g;
    }
}

TEST(HenyeyGreenstein, KeepsItsPeakInFloat) {
    for (const float g : {0.99f, -0.99f})
        for (const float h : {0.0f, 1e-6f, 1e-3f, 1.0f, 2.0f}) {
            const Vec3 after = directionAbout({0, 0, 1}, h, 0.0f);
            const float value = HenyeyGreenstein{{0, 0, 1}, g}.pdf(after);
            const long double G = std::abs(g), H = oneMinusCosine(after, {0, 0, g < 0 ? -1.0f : 1.0f});
            const long double exact =
                (1 - G * G) / (4 * 3.14159265358979323846L * std::pow(1 + G * G - 2 * G * (1 - H), 1.5L));
            EXPECT_NEAR(double(value / float(exact)), 1.0, 1e-5) << g << " " << h;
        }
}

template <typename View>
void expectSamplesDensity(const Settings& settings, const Case& c, const View& view) {
    const DirectionSampler sampler(settings, c.g);
    const Residual residual = Residual::of(ToTarget * c.C, {double(c.C), double(c.C) + double(c.excess)});
    const HenyeyGreenstein phase{Before, c.g};
    const double p = tungsten::test::chiSquareSphere(
        [&](Sampler& s) {
            const auto sample = sampler.sample(residual, c.excess, phase, view, [&s] { return s.next1D(); });
            const float pdf = sampler.pdf(residual, c.excess, sample.direction, phase, view);
            EXPECT_NEAR(sample.inversePdf * pdf, 1.0f, 2e-3f);
            return std::optional(toHost(sample.direction));
        },
        [&](const tungsten::Vec3f& d) { return double(sampler.pdf(residual, c.excess, fromHost(d), phase, view)); });
    EXPECT_GT(p, tungsten::test::SmallestPValue) << c.C << " " << c.excess << " " << c.g;
}

TEST(DirectionSampler, MixturesSampleTheirDensity) {
    for (const Case& c : Cases)
        for (const Lobe lobe : {Lobe::Path, Lobe::Photon}) {
            Settings settings = best(Mode::Photon, 0.0f);
            settings.alpha = c.alpha;
            settings.lobe = lobe;
            if (c.excess < 0.05f && lobe == Lobe::Path) continue; // narrower than the test's cells: see ConnectionLobe
            expectSamplesDensity(settings, c, NoView{});
        }
}

TEST(DirectionSampler, TheCamerasViewBelongsToTheDensity) {
    for (const Case& c : Cases)
        for (const float focus : {0.1f, 1.0f}) {
            Settings settings = best(Mode::Photon, 0.0f);
            settings.focus = focus;
            if (c.C < 0.1f || c.excess < 0.2f) continue; // thinner than the test's cells
            ConeView view{directionAbout({0, 1, 0}, 0.4f, 0.3f)};
            view.h = 0.3f;
            expectSamplesDensity(settings, c, view);
        }
}

/// Resampled directions: E[F(w) inverse pdf] = the integral of F over the sphere.
TEST(DirectionSampler, ResampledMeansMatchTheIntegral) {
    for (const Case& c : Cases)
        for (const int count : {2, 4, 8})
            for (const float focus : {0.0f, 0.2f}) {
                Settings settings = best(Mode::Photon, 0.7f);
                settings.direction = Direction::Ris;
                settings.directionCandidates = count;
                settings.focus = focus;
                const DirectionSampler sampler(settings, c.g);
                const Residual residual = Residual::of(ToTarget * c.C, {double(c.C), double(c.C) + double(c.excess)});
                const HenyeyGreenstein phase{Before, c.g};
                const ConeView view{{0, 1, 0}};
                // F = phase (1 + w.a): its integral is 1 + g (before . a).
                const Vec3 a{0.2f, -0.9f, 0.3f};
                double sum = 0.0, squares = 0.0;
                constexpr int Count = 100000;
                for (uint64_t i = 0; i < Count; ++i) {
                    Sampler s(21, RandomStream::Test, 0, i);
                    const auto sample = sampler.sample(residual, c.excess, phase, view, [&s] { return s.next1D(); });
                    const double x = double(phase.pdf(sample.direction)) * (1.0 + double(dot(sample.direction, a))) *
                                     double(sample.inversePdf);
                    sum += x, squares += x * x;
                }
                const double mean = sum / Count, error = std::sqrt((squares / Count - mean * mean) / Count);
                EXPECT_NEAR(mean, 1.0 + double(c.g * dot(Before, a)), 4.5 * error)
                    << c.C << " " << c.excess << " " << c.g << " " << count;
            }
}

} // namespace
} // namespace darts
