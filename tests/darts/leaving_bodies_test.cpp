// Directions and distances of light that leaves a body: densities by chi-square, means by quadrature, weights bounded.

#include "darts/DirectionSampler.h"
#include "darts/DistanceSampler.h"

#include "support/BodyExit.h"
#include "support/ChiSquare.h"
#include "support/Quadrature.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;
using tungsten::test::outOf;
using tungsten::test::thickMedium;

struct Place {
    double depth, height, longest, gate;
};
const Place Places[] = {{0.3, 3.0, 4.5, 0.2}, {1.0, 0.5, 1.7, 0.05}, {0.02, 5.0, 5.5, 0.4}, {2.0, 2.0, 30.0, 1.0}};

void expectDirectionsOf(Mode mode, const Place& p, float g, bool connects) {
    const HenyeyGreenstein phase{{0.6f, 0.0f, 0.8f}, g};
    const DirectionSampler sampler(best(mode, g), thickMedium(g));
    TimeBudget budget = outOf(p.depth, p.height, p.longest, p.gate);
    budget.escape.straightExit = connects;
    const float excess = std::max(budget.excess, 0.2f); // narrower lobes are thinner than the test's cells
    const double value = tungsten::test::chiSquareSphere(
        [&](Sampler& s) {
            const auto sample = sampler.sample(budget, excess, phase, [&s] { return s.next1D(); });
            const float pdf = sampler.pdf(budget, excess, sample.direction, phase);
            EXPECT_NEAR(sample.inversePdf * pdf, 1.0f, 2e-3f);
            return std::optional(tungsten::Vec3f(sample.direction.x, sample.direction.y, sample.direction.z));
        },
        [&](const tungsten::Vec3f& d) {
            return double(sampler.pdf(budget, excess, {d.x, d.y, d.z}, phase));
        });
    EXPECT_GT(value, tungsten::test::SmallestPValue) << int(mode) << " " << p.depth << " " << g << " " << connects;
}

TEST(EscapeDirections, SampleTheirDensity) {
    for (const Place& p : Places)
        for (const float g : {0.0f, 0.4f, -0.3f})
            for (const bool connects : {true, false}) expectDirectionsOf(Mode::Path, p, g, connects);
    for (const Place& p : Places)
        expectDirectionsOf(Mode::Photon, p, 0.4f, true); // camera paths take the phase function
}

/// By the product with the phase function, or mixed: E[F(w) inverse pdf] = the integral of F = phase (1 + w.a) over the
/// sphere, 1 + g (before . a).
TEST(ConvolvedPhaseLobe, MeansMatchTheIntegral) {
    const Vec3 before{0.6f, 0.0f, 0.8f}, a{0.2f, -0.9f, 0.3f};
    for (const double depth : {0.0, 0.03, 0.15})
        for (const float g : {0.5f, 0.8f, 0.99f})
            for (const bool strata : {true, false}) {
                Settings settings = best(Mode::Path, g);
                settings.direction = strata ? Direction::Product : Direction::Connection;
                const DirectionSampler sampler(settings, thickMedium(g));
                const TimeBudget budget = outOf(depth, 3.0, 3.0 + depth + 0.06, 0.05);
                EXPECT_TRUE(ConvolvedPhaseLobe::of(budget, thickMedium(g))) << depth << " " << g;
                const HenyeyGreenstein phase{before, g};
                double sum = 0.0, squares = 0.0;
                constexpr int Count = 100000;
                for (uint64_t i = 0; i < Count; ++i) {
                    Sampler s(36, RandomStream::Test, 0, i);
                    const auto sample = sampler.sample(budget, 0.02f, phase, [&s] { return s.next1D(); });
                    const float pdf = sampler.pdf(budget, 0.02f, sample.direction, phase);
                    ASSERT_NEAR(sample.inversePdf * pdf, 1.0f, 1e-5f);
                    const double weight = double(phase.pdf(sample.direction)) * double(sample.inversePdf);
                    const double x = weight * (1.0 + double(dot(sample.direction, a)));
                    sum += x, squares += x * x;
                }
                const double mean = sum / Count, error = std::sqrt((squares / Count - mean * mean) / Count);
                EXPECT_NEAR(mean, 1.0 + double(g * dot(before, a)), 4.5 * error + 1e-5) << depth << " " << g;
            }
}

TEST(ConvolvedPhaseLobe, AreForgottenDeepInside) {
    const TimeBudget deep = outOf(1.0, 3.0, 5.0, 0.05), near = outOf(0.05, 3.0, 3.1, 0.05);
    EXPECT_FALSE(ConvolvedPhaseLobe::of(deep, thickMedium(0.8f)));
    EXPECT_TRUE(ConvolvedPhaseLobe::of(near, thickMedium(0.8f)));
    EXPECT_FALSE(ConvolvedPhaseLobe::of(near, thickMedium(0.4f)));
}

/// What comes round to the target is drawn more often than by the phase function, and weighs less.
TEST(ConvolvedPhaseLobe, AreTowardsTheTarget) {
    const TimeBudget budget = outOf(0.03, 3.0, 3.06, 0.05);
    const Vec3 before = directionAbout(budget.axis, 1.0f, 0.0f); // across
    double share[2] = {0.0, 0.0};
    for (const Direction direction : {Direction::Phase, Direction::Connection}) {
        Settings settings = best(Mode::Path, 0.8f);
        settings.direction = direction;
        const DirectionSampler sampler(settings, thickMedium(0.8f));
        for (uint64_t i = 0; i < 20000; ++i) {
            Sampler s(37, RandomStream::Test, 0, i);
            const auto sample =
                sampler.sample(budget, 0.02f, HenyeyGreenstein{before, 0.8f}, [&s] { return s.next1D(); });
            share[direction == Direction::Connection] += sample.h < 0.3f ? 1.0 / 20000.0 : 0.0;
        }
    }
    EXPECT_GT(share[1], 2.0 * share[0]);
}

/// E[transmittance / pdf F(d)] = the integral of e^{-sigmaT d} F(d) over what is in time.
void expectDistancesOf(Mode mode, const Place& p, float g, double h, bool connects = true) {
    SCOPED_TRACE(testing::Message() << int(mode) << " " << p.depth << " " << g << " " << h);
    const DistanceSampler sampler(best(mode, g), thickMedium(g));
    TimeBudget budget = outOf(p.depth, p.height, p.longest, p.gate);
    budget.escape.straightExit = connects;
    const Heading ray{directionAbout(budget.axis, float(h), 0.3f), float(h)};
    const double surface = h < 1.0 ? p.depth / (1.0 - h) : 1e30,
                 end = std::min(double(budget.latest(float(h)).firstLeg()), surface);
    double sum = 0.0, squares = 0.0, reached = 0.0, reachedSquares = 0.0;
    constexpr int Count = 20000;
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler s(32, RandomStream::Test, 0, i);
        const DistanceSample sample =
            sampler.sample(budget, ray, float(surface), {1, 1, 1}, {s.next1D(), s.next1D(), s.next1D(), s.next1D()});
        const double weight = double(sample.transmittanceOverPdf.x);
        const double x = sample.surface ? 0.0 : weight * (1.0 + double(sample.distance));
        sum += x, squares += x * x;
        reached += sample.surface ? weight : 0.0;
        reachedSquares += sample.surface ? weight * weight : 0.0;
    }
    const auto error = [](double total, double totalSquares) {
        return std::sqrt((totalSquares / Count - total * total / (double(Count) * Count)) / Count);
    };
    const double expected =
        tungsten::test::integrate<31>([](double d) { return std::exp(-10.02 * d) * (1.0 + d); }, 0.0, end, 15, 1e-10);
    EXPECT_NEAR(sum / Count, expected, 5.0 * error(sum, squares) + 1e-5 * expected);
    if (end == surface && end < 0.6) {
        EXPECT_NEAR(reached / Count, std::exp(-10.02 * surface), 5.0 * error(reached, reachedSquares) + 1e-6);
    }
}

TEST(DistancesOut, MeansMatchQuadrature) {
    for (const Mode mode : {Mode::Path, Mode::Photon})
        for (const Place& p : Places)
            for (const float g : {0.0f, 0.8f})
                for (const double h : {0.05, 1.0, 1.9}) expectDistancesOf(mode, p, g, h);
    for (const Place& p : Places)
        for (const double h : {0.05, 1.0, 1.9}) expectDistancesOf(Mode::Photon, p, 0.0f, h, false);
}

/// Where light leaves by refraction nothing is known of where: no weight is above that of a free flight, or twice that
/// of a uniform proposal beside it.
TEST(DistancesOut, NothingIsRareBehindRefraction) {
    const auto heaviest = [](bool connects) {
        const DistanceSampler sampler(best(Mode::Photon, 0.0f), thickMedium(0.0f));
        TimeBudget budget = outOf(0.5, 3.0, 4.1, 0.09);
        budget.escape.straightExit = connects;
        float most = 0.0f;
        for (uint64_t i = 0; i < 50000; ++i) {
            Sampler s(35, RandomStream::Test, 0, i);
            const Heading ray{directionAbout(budget.axis, 2.0f * s.next1D(), s.next1D()), 0.0f};
            const DistanceSample sample = sampler.sample(budget, budget.heading(ray.direction), 1e30f, {1, 1, 1},
                                                         {s.next1D(), s.next1D(), s.next1D(), s.next1D()});
            most = std::max(most, 10.02f * sample.transmittanceOverPdf.x);
        }
        return most;
    };
    EXPECT_LE(heaviest(false), 2.0f);
    EXPECT_GT(heaviest(true), 2.0f);
}

/// Deep in a body importance hardly varies within a flight: nor may weights, which multiply over hundreds of them.
TEST(DistancesOut, WeightsOfCameraPathsHardlyVaryDeepInside) {
    const auto spread = [](bool logLinear) {
        Settings settings = best(Mode::Path, 0.0f);
        settings.preset = logLinear ? Preset::Best : Preset::Published;
        const DistanceSampler sampler(settings, thickMedium(0.0f));
        const TimeBudget budget = outOf(2.0, 3.0, 45.0, 0.15);
        double squares = 0.0;
        constexpr int Count = 5000;
        for (uint64_t i = 0; i < Count; ++i) {
            Sampler s(34, RandomStream::Test, 0, i);
            const Heading ray{directionAbout(budget.axis, 2.0f * s.next1D(), s.next1D()), 0.0f};
            const DistanceSample sample = sampler.sample(budget, budget.heading(ray.direction), 1e30f, {1, 1, 1},
                                                         {s.next1D(), s.next1D(), s.next1D(), s.next1D()});
            const double log = std::log(10.02 * double(sample.transmittanceOverPdf.x));
            squares += log * log;
        }
        return std::sqrt(squares / Count);
    };
    const double logLinear = spread(true), candidates = spread(false);
    RecordProperty("log_linear", std::to_string(logLinear));
    RecordProperty("candidates", std::to_string(candidates));
    EXPECT_LT(logLinear, 0.3 * candidates);
}

} // namespace
} // namespace darts
