// Gates, frames and the sensor's response.

#include "darts/Guide.h"

#include "support/ChiSquare.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;

TEST(FrameSequence, StratifiedChoiceVisitsEveryFrameEquallyOften) {
    const FrameSequence frames{2.0, 0.5, 7};
    std::vector<int> counts(7, 0);
    for (uint64_t i = 0; i < 70; ++i) ++counts[size_t(frames.stratified(i, 0.6f))];
    for (const int count : counts) EXPECT_EQ(count, 10);
    EXPECT_DOUBLE_EQ(frames.frame(3).begin, 3.5);
    EXPECT_DOUBLE_EQ(frames.frame(3).end, 4.0);
    EXPECT_DOUBLE_EQ(frames.all().end, 5.5);
}

TEST(TimeBudget, KeepsShortGatesAtTheEndOfLongPaths) {
    // A gate of 1e-4 after 1e3 of path; the target is 300 away.
    const LengthInterval range = LengthInterval::of({1000.0, 1000.0 + 1e-4}, 500.0, 1.0);
    const TimeBudget r = TimeBudget::of({0, 0, 300}, range);
    EXPECT_NEAR(r.width, 1e-4, 1e-10);
    EXPECT_NEAR(r.shortest, 500.0, 1e-10);
    EXPECT_NEAR(r.low, 200.0, 1e-4);
    EXPECT_TRUE(r.alive());
    EXPECT_FALSE(TimeBudget::of({0, 0, 600}, range).alive());
    // The gate's begin has passed: what is left of it starts at the straight line.
    const TimeBudget late = TimeBudget::of({0, 0, 1}, {0.5, 1.25});
    EXPECT_EQ(late.low, 0.0f);
    EXPECT_EQ(late.width, 0.25f);
}

const TemporalResponse TwoPeaks =
    TemporalResponse::tabulated({1.0, 1.1, 1.2, 1.6, 1.7, 1.8}, {0.0, 3.0, 0.0, 0.0, 1.0, 0.0});

TEST(TemporalResponse, DensityDistributionAndQuantileBelongTogether) {
    for (const TemporalResponse& w : {TemporalResponse::box(2.0, 2.5), TemporalResponse::gaussian(3.0, 0.2), TwoPeaks,
                                      TemporalResponse::tabulated({0.0, 1.0, 4.0}, {1.0, 2.0, 0.5})}) {
        constexpr int Steps = 200000;
        double integral = 0.0;
        for (int i = 0; i < Steps; ++i) {
            const double width = (w.end() - w.begin()) / Steps, time = w.begin() + (i + 0.5) * width;
            integral += w.pdf(time) * width;
            if (i % 1000 == 0) {
                EXPECT_NEAR(w.distribution(time + 0.5 * width), integral, 1e-6);
            }
        }
        EXPECT_NEAR(integral, 1.0, 1e-6);
        EXPECT_EQ(w.pdf(w.begin() - 0.01), 0.0);
        EXPECT_EQ(w.pdf(w.end()), 0.0);
        double last = w.begin();
        for (int i = 0; i < 100000; ++i) {
            Sampler s(3, RandomStream::Test, 0, uint64_t(i));
            const double u = s.nextDouble(), time = w.quantile(u);
            ASSERT_NEAR(w.distribution(time), u, 1e-9);
            ASSERT_GT(w.pdf(time), 0.0);
        }
        for (int i = 0; i <= 1000; ++i) {
            const double time = w.quantile(i / 1000.0);
            ASSERT_GE(time, last);
            last = time;
        }
    }
}

TEST(TemporalResponse, ConvolutionIsTheDensityOfASum) {
    // Two boxes: a trapezoid, exactly.
    const TemporalResponse ramp =
        TemporalResponse::convolved(TemporalResponse::box(1.0, 2.0), TemporalResponse::box(-0.5, 2.5));
    EXPECT_DOUBLE_EQ(ramp.begin(), 0.5);
    EXPECT_DOUBLE_EQ(ramp.end(), 4.5);
    for (int i = 0; i <= 100; ++i) {
        const double t = 0.5 + 0.04 * i;
        EXPECT_NEAR(ramp.pdf(t), std::clamp(std::min(t - 0.5, 4.5 - t), 0.0, 1.0) / 3.0, 1e-12) << t;
    }
    // Gaussians: a gaussian.
    const TemporalResponse sum =
        TemporalResponse::convolved(TemporalResponse::gaussian(1.0, 0.3), TemporalResponse::gaussian(2.0, 0.4));
    for (double t = 1.6; t < 4.4; t += 0.07)
        EXPECT_NEAR(sum.distribution(t), 0.5 * std::erfc((3.0 - t) / (0.5 * std::sqrt(2.0))), 5e-4) << t;
    // Any two: quantiles of each, added.
    const TemporalResponse step = TemporalResponse::tabulated({0.0, 1.0, 4.0}, {1.0, 2.0, 0.5});
    const TemporalResponse both = TemporalResponse::convolved(TwoPeaks, step);
    constexpr int Samples = 200000;
    std::array<int, 8> below{};
    for (int i = 0; i < Samples; ++i) {
        Sampler s(5, RandomStream::Test, 0, uint64_t(i));
        const double time = TwoPeaks.quantile(s.nextDouble()) + step.quantile(s.nextDouble());
        for (size_t k = 0; k < below.size(); ++k) below[k] += time < 1.2 + 0.5 * double(k) ? 1 : 0;
    }
    for (size_t k = 0; k < below.size(); ++k) {
        const double expected = both.distribution(1.2 + 0.5 * double(k));
        EXPECT_NEAR(below[k] / double(Samples), expected,
                    4.5 * std::sqrt(expected * (1.0 - expected) / Samples) + 1e-5);
    }
}

TEST(TemporalResponse, RefusesWhatIsNoResponse) {
    EXPECT_THROW(TemporalResponse::tabulated({0, 1}, {0, 0}), std::invalid_argument);
    EXPECT_THROW(TemporalResponse::tabulated({0, 0}, {1, 1}), std::invalid_argument);
    EXPECT_THROW(TemporalResponse::tabulated({0, 1}, {1, -1}), std::invalid_argument);
    EXPECT_THROW(TemporalResponse::tabulated({0}, {1}), std::invalid_argument);
    EXPECT_THROW(TemporalResponse::tabulated({0, 1, 2}, {1, 1}), std::invalid_argument);
    EXPECT_THROW(TemporalResponse::tabulated({0, NAN}, {1, 1}), std::invalid_argument);
}

TEST(TemporalResponse, ConnectionsFollowItInsideTheResidualRange) {
    // Elapsed 0.9 at speed 2, the target 0.3 away: arrival between 1.05 and 1.7 is possible and asked for.
    const Guide guide(best(Mode::Path, 0.0f), Medium{{0, 0, 0}, {1, 1, 1}, 0.0f});
    const LengthInterval range = LengthInterval::of({TwoPeaks.begin(), 1.7}, 0.9, 2.0);
    const TimeBudget budget = TimeBudget::of({0.3f, 0, 0}, range);
    const double low = TwoPeaks.distribution(1.05), high = TwoPeaks.distribution(1.7);
    std::vector<double> quantiles;
    const double p = tungsten::test::chiSquareUniform(
        [&](Sampler& s) {
            const ConnectionSample c = guide.sampleConnection(budget, s.next1D(), {&TwoPeaks, 0.9, 2.0});
            const double time = 0.9 + (0.3 + double(c.excess)) / 2.0;
            EXPECT_NEAR(double(c.inversePdf) * TwoPeaks.pdf(time), 2.0 * (high - low), 1e-4);
            return (TwoPeaks.distribution(time) - low) / (high - low);
        },
        12, 5000);
    EXPECT_GT(p, tungsten::test::SmallestPValue);
}

/// The experiment of He et al. 2024, figure 7: a sensor that sees two short times.
TEST(TemporalResponse, ControlVerticesHitTwoPeaksThatPlainConnectionsMiss) {
    const Medium medium{{0, 0, 0}, {1, 1, 1}, 0.0f};
    const Settings settings = best(Mode::Path, 0.0f);
    const Guide guide(settings, medium);
    const TemporalResponse peaks =
        TemporalResponse::tabulated({2.0, 2.05, 2.1, 3.0, 3.05, 3.1}, {0.0, 1.0, 0.0, 0.0, 1.0, 0.0});
    const Vec3 target{1, 0, 0};
    uint64_t plain = 0, plainOutside = 0, elliptical = 0, ellipticalOutside = 0;
    for (uint64_t i = 0; i < 20000; ++i) {
        Sampler s(9, RandomStream::Test, 0, i);
        const auto random = [&s] { return s.next1D(); };
        // Free flights, a connection at every vertex that can still be in time.
        Vec3 position{0, 0, 0}, direction{0, 0, 1};
        for (double elapsed = 0.0; elapsed < peaks.end();) {
            const float flight = -std::log1p(-s.next1D());
            position = position + direction * flight;
            elapsed += double(flight);
            const double arrival = elapsed + double(length(target - position));
            if (arrival >= peaks.end()) break;
            ++plain;
            if (!(peaks.pdf(arrival) > 0.0)) ++plainOutside;
            direction = HenyeyGreenstein{direction, 0.0f}.sample(s.next1D(), s.next1D());
        }
        position = {0, 0, 0}, direction = {0, 0, 1};
        double elapsed = 0.0;
        for (int bounce = 0; bounce < 20; ++bounce) {
            const LengthInterval range = LengthInterval::of({peaks.begin(), peaks.end()}, elapsed, 1.0);
            const TimeBudget budget = TimeBudget::of(target - position, range);
            if (!budget.alive()) break;
            const auto connection = guide.sampleConnection(budget, s.next1D(), {&peaks, elapsed, 1.0});
            const HenyeyGreenstein phase{direction, 0.0f};
            const DirectionSample next = guide.sampleDirection(budget, connection, phase, random);
            if (const auto vertex = guide.controlVertex(budget, connection, next.h, INFINITY)) {
                const Vec3 at = position + next.direction * vertex->distance;
                const double time = elapsed + double(vertex->distance) + double(length(target - at));
                ++elliptical;
                if (!(peaks.pdf(time) > 0.0)) ++ellipticalOutside;
            }
            const DistanceSample step = guide.sampleDistance(budget, next, INFINITY, {1, 1, 1}, random);
            if (!(step.transmittanceOverPdf.x > 0.0f)) break;
            position = position + next.direction * step.distance;
            direction = next.direction;
            elapsed += double(step.distance);
        }
    }
    EXPECT_GT(double(plainOutside), 0.8 * double(plain));
    EXPECT_LT(double(ellipticalOutside), 0.03 * double(elliptical));
    EXPECT_GT(elliptical, 40000u);
}

} // namespace
} // namespace darts
