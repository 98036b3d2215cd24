// Directions: every mixture against its density, the resampled ones against quadrature.

#include "darts/DirectionSampler.h"

#include "support/ChiSquare.h"
#include "support/Quadrature.h"

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

struct DirectionCase {
    float C, excess, g;
    float alpha;
};
const DirectionCase DirectionCases[] = {{1.0f, 0.3f, 0.0f, 0.1f},
                                        {1.0f, 0.02f, 0.3f, 0.5f},
                                        {2.0f, 8.0f, -0.6f, 0.2f},
                                        {0.5f, 0.1f, 0.7f, 1.0f},
                                        {1e-6f, 1.0f, 0.4f, 0.1f}};
const Vec3 Before = Vec3{0.6f, 0.0f, 0.8f};
const Vec3 ToTarget = Vec3{0.48f, 0.64f, -0.6f};

/// Coloured, of mean sigmaT 2 and mean albedo 0.8.
Medium coloured(float g) {
    return {{0.3f, 0.4f, 0.5f}, {1.7f, 1.6f, 1.5f}, g};
}

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

void expectSamplesDensity(const Settings& settings, const DirectionCase& c) {
    const DirectionSampler sampler(settings, coloured(c.g));
    const TimeBudget budget = TimeBudget::of(ToTarget * c.C, {double(c.C), double(c.C) + double(c.excess)});
    const HenyeyGreenstein phase{Before, c.g};
    const double p = tungsten::test::chiSquareSphere(
        [&](Sampler& s) {
            const auto sample = sampler.sample(budget, c.excess, phase, [&s] { return s.next1D(); });
            const float pdf = sampler.pdf(budget, c.excess, sample.direction, phase);
            EXPECT_NEAR(sample.inversePdf * pdf, 1.0f, 2e-3f);
            return std::optional(toHost(sample.direction));
        },
        [&](const tungsten::Vec3f& d) { return double(sampler.pdf(budget, c.excess, fromHost(d), phase)); });
    EXPECT_GT(p, tungsten::test::SmallestPValue) << c.C << " " << c.excess << " " << c.g;
}

TEST(DirectionSampler, MixturesSampleTheirDensity) {
    for (const DirectionCase& c : DirectionCases)
        for (const Lobe lobe : {Lobe::Path, Lobe::Photon}) {
            Settings settings = best(Mode::Photon, 0.0f);
            settings.alpha = c.alpha;
            settings.lobe = lobe;
            if (c.excess < 0.05f && lobe == Lobe::Path) continue; // narrower than the cells: see NarrowMixtures
            expectSamplesDensity(settings, c);
        }
}

TEST(DirectionSampler, MixturesWithTheEdaTableSampleTheirDensity) {
    for (const DirectionCase& c : DirectionCases)
        for (const Mode mode : {Mode::Path, Mode::Photon}) {
            Settings settings = published(mode);
            settings.alpha = c.alpha;
            expectSamplesDensity(settings, c);
        }
}

/// Needles need cells of their own, in h; isotropic, so that the density is a function of h alone.
TEST(DirectionSampler, NarrowMixturesSampleTheirDensityWhichIntegratesToOne) {
    for (const Direction direction : {Direction::Connection, Direction::Eda})
        for (const Lobe lobe : {Lobe::Path, Lobe::Photon})
            for (const float excess : {1e-4f, 1e-3f, 0.02f, 3.0f}) {
                if (direction == Direction::Eda && lobe == Lobe::Photon) continue; // one table for both
                Settings settings = best(Mode::Path, 0.0f);
                settings.direction = direction;
                settings.lobe = lobe;
                const DirectionSampler sampler(settings, coloured(0.0f));
                const TimeBudget budget = TimeBudget::of(ToTarget, {1.0, 1.0 + double(excess)});
                const auto density = [&](double h) {
                    const Vec3 d = directionAbout(budget.axis, float(h), 0.3f);
                    return 2.0 * double(Pi) * double(sampler.pdf(budget, excess, d, HenyeyGreenstein{}));
                };
                auto edges = tungsten::test::ratioEdges(1e-10, 2.0, 60);
                edges.insert(edges.begin(), 0.0);
                edges.back() = 2.0 + 1e-9; // h = 2 belongs to the last cell
                double integral = 0.0;
                for (size_t i = 0; i + 1 < edges.size(); ++i)
                    integral += tungsten::test::integrate<15>(density, edges[i], edges[i + 1], 8, 1e-6);
                EXPECT_NEAR(integral, 1.0, 1e-3) << int(direction) << " " << excess;
                const double p = tungsten::test::chiSquareInterval(
                    [&](Sampler& s) {
                        const auto random = [&s] { return s.next1D(); };
                        return double(sampler.sample(budget, excess, HenyeyGreenstein{}, random).h);
                    },
                    density, edges);
                EXPECT_GT(p, tungsten::test::SmallestPValue) << int(direction) << " " << int(lobe) << " " << excess;
            }
}

TEST(DirectionSampler, TheEdaTablesShareIsTheTablesOwnDensity) {
    const auto table = std::make_shared<const EdaTable>(EdaTable::build(0.8f, 0.3f));
    const DirectionSampler built(published(Mode::Path), coloured(0.3f));
    const DirectionSampler given(published(Mode::Path), coloured(0.3f), table);
    const HenyeyGreenstein phase{Before, 0.3f};
    for (uint64_t i = 0; i < 2000; ++i) {
        Sampler s(22, RandomStream::Test, 0, i);
        const float C = std::exp(6.0f * s.next1D() - 3.0f), excess = C * std::exp2(-20.0f * s.next1D());
        const TimeBudget budget = TimeBudget::of(ToTarget * C, {0.0, double(C) + double(excess)});
        const float share = budget.C / (budget.C + excess) / (budget.C / (budget.C + excess) + 0.5f);
        const Vec3 direction = directionAbout(ToTarget, 2.0f * std::exp2(-20.0f * s.next1D()), s.next1D());
        const float h = oneMinusCosine(direction, budget.axis);
        const float expected = share * table->pdf(budget.C, excess, 2.0f, h) + (1.0f - share) * phase.pdf(direction);
        for (const DirectionSampler* sampler : {&built, &given})
            ASSERT_NEAR(sampler->pdf(budget, excess, direction, phase) / expected, 1.0f, 1e-5f)
                << C << " " << excess << " " << h;
    }
}

TEST(DirectionSampler, EmptyMediaHaveNoTableAndUseThePhaseFunction) {
    const DirectionSampler sampler(published(Mode::Path), Medium{});
    const TimeBudget budget = TimeBudget::of({0, 0, 1}, {1.0, 1.5});
    const HenyeyGreenstein phase{Before, 0.3f};
    EXPECT_EQ(sampler.pdf(budget, 0.5f, ToTarget, phase), phase.pdf(ToTarget));
}

TEST(DirectionSampler, WithoutAShareOfThePhaseFunctionATargetAtTheVertexStillHasDirections) {
    Settings settings = best(Mode::Path, 0.0f);
    settings.alpha = 0.0f;
    const DirectionSampler sampler(settings, coloured(0.0f));
    const TimeBudget budget = TimeBudget::of({0, 0, 0}, {0.0, 1.0});
    const auto sample = sampler.sample(budget, 1.0f, HenyeyGreenstein{}, [] { return 0.25f; });
    EXPECT_NEAR(sample.inversePdf, 4.0f * Pi, 1e-4f);
}

/// Resampled directions: E[F(w) inverse pdf] = the integral of F over the sphere.
TEST(DirectionSampler, ResampledMeansMatchTheIntegral) {
    for (const DirectionCase& c : DirectionCases)
        for (const int count : {2, 4, 8}) {
            Settings settings = best(Mode::Photon, 0.7f);
            settings.direction = Direction::Ris;
            settings.directionCandidates = count;
            const DirectionSampler sampler(settings, coloured(c.g));
            const TimeBudget budget = TimeBudget::of(ToTarget * c.C, {double(c.C), double(c.C) + double(c.excess)});
            const HenyeyGreenstein phase{Before, c.g};
            // F = phase (1 + w.a): its integral is 1 + g (before . a).
            const Vec3 a{0.2f, -0.9f, 0.3f};
            double sum = 0.0, squares = 0.0;
            constexpr int Count = 100000;
            for (uint64_t i = 0; i < Count; ++i) {
                Sampler s(21, RandomStream::Test, 0, i);
                const auto sample = sampler.sample(budget, c.excess, phase, [&s] { return s.next1D(); });
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
