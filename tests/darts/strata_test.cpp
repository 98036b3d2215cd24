// Directions by the product of a forward peak and a guide: the density integrates to 1, and samples follow it.

#include "darts/DirectionSampler.h"

#include "support/BodyExit.h"
#include "support/ChiSquare.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;

using Lobe = AboutTarget<ConnectionLobe<float>>;

struct Strata {
    HenyeyGreenstein phase;
    Lobe guide;
    DirectionStrata<Lobe> strata;

    Strata(float g, float between, const ConnectionLobe<float>& lobe)
        : phase{Vec3{0.6f, 0.0f, 0.8f}, g}, guide{lobe, directionAbout(phase.peak(), between, 0.2f)},
          strata(phase, guide,
                 [](const Vec3&, float, float own, float guided) { return own * (4.0f * Pi * guided + 0.2f); }) {}

    Vec3 sample(Sampler& s) const {
        const float choice = s.next1D(), u = s.next1D(), v = s.next1D();
        return strata.sample(choice, u, v);
    }
    float pdf(const Vec3& direction) const { return strata.pdf(direction, oneMinusCosine(direction, guide.axis)); }
    /// Sixths of both distributions by the angle to their axes, and quarters of the turn about each.
    size_t cell(const Vec3& direction) const {
        const auto part = [](float p) { return size_t(std::clamp(int(p * 6.0f), 0, 5)); };
        const auto turn = [&](const Vec3& axis) {
            const Vec3 x = directionAbout(axis, 1.0f, 0.0f), y = directionAbout(axis, 1.0f, 0.25f);
            return size_t(dot(direction, x) < 0) * 2 + size_t(dot(direction, y) < 0);
        };
        const size_t own = 4 * part(phase.part(oneMinusCosine(direction, phase.peak()))) + turn(phase.peak());
        const size_t guided = 4 * part(guide.part(oneMinusCosine(direction, guide.axis))) + turn(guide.axis);
        return 24 * own + guided;
    }
};

/// What cells hold is estimated by samples of both distributions, fifty times as many: peaks are too sharp for
/// quadrature on the sphere.
void expectSamplesDensity(const Strata& strata) {
    constexpr int Samples = 20000, References = 1000000;
    std::vector<double> observed(576, 0.0), expected(576, 0.0);
    double sum = 0.0, squares = 0.0;
    for (uint64_t i = 0; i < References; ++i) {
        Sampler s(91, RandomStream::Test, 0, i);
        const float u = s.next1D(), v = s.next1D();
        const Vec3 direction = i % 2 == 0 ? strata.phase.sample(u, v) : strata.guide.sample(0.0f, u, v);
        const float mixture =
            0.5f * (strata.phase.pdf(direction) + strata.guide.pdf(oneMinusCosine(direction, strata.guide.axis)));
        const double weight = double(strata.pdf(direction) / mixture);
        expected[strata.cell(direction)] += weight * Samples / References;
        sum += weight, squares += weight * weight;
    }
    const double mean = sum / References, error = std::sqrt((squares / References - mean * mean) / References);
    EXPECT_NEAR(mean, 1.0, 4.5 * error + 1e-5);
    for (uint64_t i = 0; i < Samples; ++i) {
        Sampler s(92, RandomStream::Test, 0, i);
        const Vec3 direction = strata.sample(s);
        ASSERT_NEAR(length(direction), 1.0f, 1e-5f);
        ASSERT_GT(strata.pdf(direction), 0.0f);
        observed[strata.cell(direction)] += 1.0;
    }
    EXPECT_GT(tungsten::test::chiSquarePValue(observed, expected), tungsten::test::SmallestPValue);
}

TEST(DirectionStrata, SamplesFollowTheDensityWhichIntegratesToOne) {
    for (const float g : {0.5f, 0.9f, 0.99f, -0.7f})
        for (const float delta : {1e-3f, 3.0f})
            for (const float between : {0.0f, 0.5f, 2.0f}) {
                SCOPED_TRACE(testing::Message() << g << " " << delta << " " << between);
                expectSamplesDensity({g, between,
                                      delta < 1.0f ? ConnectionLobe<float>::path(1.0f, delta)
                                                   : ConnectionLobe<float>::photon(1.0f, delta)});
            }
}

/// Broad ones on the sphere itself.
TEST(DirectionStrata, BroadProductsFollowTheirDensityOnTheSphere) {
    for (const float g : {0.5f, -0.7f})
        for (const float between : {0.0f, 0.9f, 2.0f}) {
            const Strata strata(g, between, ConnectionLobe<float>::photon(1.0f, 2.0f));
            const double p = tungsten::test::chiSquareSphere(
                [&](Sampler& s) {
                    const Vec3 d = strata.sample(s);
                    return std::optional(tungsten::Vec3f(d.x, d.y, d.z));
                },
                [&](const tungsten::Vec3f& d) {
                    return double(strata.pdf({d.x, d.y, d.z}));
                },
                11, 50000);
            EXPECT_GT(p, tungsten::test::SmallestPValue) << g << " " << between;
        }
}

/// Where the product is wanted, directions are drawn in proportion to it: weights vary less than those of the mixture.
TEST(DirectionStrata, WeightsVaryLessThanThoseOfAMixture) {
    for (const float g : {0.9f, 0.98f}) { // 0.61 of them
        const Strata strata(g, 0.1f, ConnectionLobe<float>::path(1.0f, 0.3f));
        double squares[2] = {0.0, 0.0};
        for (uint64_t i = 0; i < 50000; ++i) {
            Sampler s(93, RandomStream::Test, 0, i);
            const auto add = [&](double& sum, const Vec3& direction, float pdf) {
                const float h = oneMinusCosine(direction, strata.guide.axis);
                const double x = double(strata.phase.pdf(direction) * strata.guide.pdf(h) / pdf);
                sum += x * x;
            };
            const Vec3 product = strata.sample(s);
            add(squares[0], product, strata.pdf(product));
            const float u = s.next1D(), v = s.next1D();
            const Vec3 mixed = i % 2 == 0 ? strata.phase.sample(u, v) : strata.guide.sample(0.0f, u, v);
            const float h = oneMinusCosine(mixed, strata.guide.axis);
            add(squares[1], mixed, 0.5f * (strata.phase.pdf(mixed) + strata.guide.pdf(h)));
        }
        EXPECT_LT(squares[0], 0.7 * squares[1]) << g;
    }
}

/// As DirectionSampler uses them: towards the target, and towards the boundary of a body.
TEST(DirectionStrata, DrawsOfTheSamplerKnowTheirDensity) {
    for (const float g : {0.5f, 0.9f, -0.7f})
        for (const bool out : {false, true}) {
            const Medium medium = tungsten::test::thickMedium(g);
            const DirectionSampler sampler(best(Mode::Photon, g), medium);
            TimeBudget budget = tungsten::test::outOf(0.03, 3.0, 3.08, 0.05);
            if (!out) budget.model = EscapeModel::Infinite;
            const HenyeyGreenstein phase{{0.6f, 0.0f, 0.8f}, g};
            double sum = 0.0, squares = 0.0; // of the integral of the phase function
            constexpr int Count = 50000;
            for (uint64_t i = 0; i < Count; ++i) {
                Sampler s(94, RandomStream::Test, 0, i);
                const auto sample = sampler.sample(budget, 0.02f, phase, [&s] { return s.next1D(); });
                const float pdf = sampler.pdf(budget, 0.02f, sample.direction, phase);
                ASSERT_NEAR(sample.inversePdf * pdf, 1.0f, 1e-3f) << g << " " << out;
                const double x = double(phase.pdf(sample.direction)) * double(sample.inversePdf);
                sum += x, squares += x * x;
            }
            const double mean = sum / Count, error = std::sqrt((squares / Count - mean * mean) / Count);
            EXPECT_NEAR(mean, 1.0, 4.5 * error) << g << " " << out;
        }
}

} // namespace
} // namespace darts
