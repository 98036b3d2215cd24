// First passage out of a body: probabilities against the integrated flux, slopes against differences, registers against
// single places.

#include "darts/Guide.h"

#include "support/BodyExit.h"
#include "support/Quadrature.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::test::outOf;
using tungsten::test::thickMedium;

constexpr double SigmaA = 0.02, ReducedS = 10.0;
constexpr double D = 1.0 / (3.0 * (SigmaA + ReducedS));

double logPassage(const TimeBudget& budget, float allowance) {
    const FirstPassage passage(float(SigmaA), float(ReducedS), budget.escape, allowance);
    return double(passage.log({budget.escape, budget.latest(0), budget.axis, 0.0f}));
}

/// Density per length of leaving at s from depth z under a half-space whose boundary sends back a part of what meets
/// it, but for absorption: 1 / z_b of the diffusing light there, by an image source and a line of sinks behind it.
double flux(double z, double s, double mismatch = 1.0) {
    const double zb = 2.0 * mismatch * D, spread = 4.0 * D * s;
    const double images = 2.0 * std::exp(-z * z / spread);
    const double sinks =
        tungsten::test::integrate<31>([&](double l) { return std::exp(-(z + l) * (z + l) / spread - l / zb); }, 0.0,
                                      12.0 * std::sqrt(spread), 15, 1e-10);
    return D / zb * (images - 2.0 / zb * sinks) / std::sqrt(M_PI * spread);
}

TEST(FirstPassage, IsTheFluxThroughTheBoundaryIntegratedOverTheGate) {
    for (const double depth : {0.05, 0.3, 1.0})
        for (const double length : {0.5, 2.0, 12.0})
            for (const double gate : {0.002, 0.2, 0.45}) {
                // Target straight above: what is left inside is the depth and the whole excess.
                const TimeBudget budget = outOf(depth, 3.0, 3.0 + length, gate);
                if (!budget.alive()) continue;
                const double expected = tungsten::test::integrate<31>([&](double s) { return flux(depth, s); },
                                                                      std::max(length - gate, depth), length, 15, 1e-9);
                // The gate's start is moved by at most 1e-4 of a mean free path.
                const double tolerance = 2e-3 + 2e-5 / gate;
                EXPECT_NEAR(logPassage(budget, 0.0f), std::log(expected) - SigmaA * length, tolerance)
                    << depth << " " << length << " " << gate;
            }
}

/// Unpolarised, from inside at relative index n.
double fresnel(double n, double cosine) {
    const double sine2 = n * n * (1.0 - cosine * cosine);
    if (sine2 >= 1.0) return 1.0;
    const double beyond = std::sqrt(1.0 - sine2);
    const double parallel = (cosine - n * beyond) / (cosine + n * beyond),
                 perpendicular = (n * cosine - beyond) / (n * cosine + beyond);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

TEST(FirstPassage, LeavesSlowlyWhereTheBoundaryReflects) {
    EXPECT_EQ(boundaryReflectionA(1.0f), 1.0f);
    for (const double n : {1.2, 1.4, 1.5}) {
        const double reflectance = tungsten::test::integrate<31>(
            [n](double cosine) { return 2.0 * cosine * fresnel(n, cosine); }, 0.0, 1.0, 15, 1e-8);
        EXPECT_NEAR(boundaryReflectionA(float(n)), (1.0 + reflectance) / (1.0 - reflectance), 0.1) << n;
    }
    TimeBudget budget = outOf(0.3, 3.0, 5.0, 0.2);
    budget.escape.reflectionA = 2.95f;
    const double length = 2.0;
    const double expected =
        tungsten::test::integrate<31>([&](double s) { return flux(0.3, s, 2.95); }, length - 0.2, length, 15, 1e-9);
    EXPECT_NEAR(logPassage(budget, 0.0f), std::log(expected) - SigmaA * length, 3e-3);
}

/// Light at a boundary that reflects nearly all of it may leave at any time. Guided light paths that took it for
/// hopeless ended there: bodies of an index of 3 and more were black.
TEST(FirstPassage, LeavesSoonHoweverMuchTheBoundaryReflects) {
    const auto at = [](double length, float mismatch) {
        TimeBudget budget = outOf(0.01, 3.0, 3.0 + length, 0.1);
        budget.escape.reflectionA = mismatch;
        return logPassage(budget, 1.0f);
    };
    for (const float index : {1.5f, 2.0f, 3.0f, 4.0f, 20.0f})
        EXPECT_GT(at(0.3, boundaryReflectionA(index)) - at(10.0, boundaryReflectionA(index)), -10.0) << index;
}

TEST(FirstPassage, SlabsLoseLightThroughTheirBack) {
    const auto absorbed = [](double y, double s) { // flux through a boundary that lets all out
        return y / std::sqrt(4.0 * M_PI * D * s * s * s) * std::exp(-y * y / (4.0 * D * s));
    };
    const double thickness = 0.5, length = 4.0;
    const auto at = [&](double depth, double time) {
        TimeBudget budget = outOf(depth, 3.0, 3.0 + time, 0.05);
        budget.escape.faces[0].thickness = float(thickness);
        return logPassage(budget, 0.0f);
    };
    const double wide = thickness + 4.0 * D;
    const auto exact = [&](double depth) { // image sources
        double sum = 0.0;
        for (int m = -6; m <= 6; ++m) sum += absorbed(depth + 2.0 * D + 2.0 * m * wide, length);
        return std::log(sum);
    };
    EXPECT_NEAR(at(0.4, length) - at(0.1, length), exact(0.4) - exact(0.1), 0.3);
    EXPECT_LT(at(0.4, length), logPassage(outOf(0.4, 3.0, 3.0 + length, 0.05), 0.0f) - 0.3);
    // Early light has not felt the back.
    EXPECT_NEAR(at(0.05, 0.08), logPassage(outOf(0.05, 3.0, 3.08, 0.05), 0.0f), 1e-3);
}

/// Outside light is 2.5 times as fast: connections in time are longer than at the speed inside any could be.
TEST(FirstPassage, KnowsThatLightIsFasterOutside) {
    constexpr double Depth = 0.3, Height = 3.0, OuterSpeed = 0.4, Gate = 0.1, Left = 0.8;
    // Lengths of time at the speed inside: so much is left there when light has flown the height outside.
    TimeBudget budget = outOf(Depth, Height, Left + OuterSpeed * Height, Gate);
    EXPECT_FALSE(budget.alive());
    const float extra = float((1.0 / OuterSpeed - 1.0) * (Left + OuterSpeed * Height));
    budget.excess += extra;
    budget.width += extra;
    budget.escape.extraLength = extra;
    budget.escape.outerSpeed = float(OuterSpeed);
    const double expected =
        tungsten::test::integrate<31>([&](double s) { return flux(Depth, s); }, Left - Gate, Left, 15, 1e-9);
    EXPECT_NEAR(logPassage(budget, 0.0f), std::log(expected) - SigmaA * Left, 2e-3 + 2e-5 / Gate);
}

/// However late: a target of 0 would be a bias.
TEST(FirstPassage, IsNeverZero) {
    for (const double length : {1e-3, 1.0, 1e4, 1e7})
        for (const double gate : {1e-6, 0.1}) {
            TimeBudget budget = outOf(0.01, 3.0, 3.01 + length, gate);
            budget.escape.faces[0].thickness = 0.02f;
            const FirstPassage passage(float(SigmaA), float(ReducedS), budget.escape);
            float factor = 0.0f;
            (void)passage.exponent(EscapePoint<float>(budget.escape, budget.latest(0), budget.axis, 0.0f), factor);
            EXPECT_GT(factor, 0.0f) << length << " " << gate;
        }
}

/// A control vertex as deep as can be, seen from a boundary that hides nearer ones: rare, but not lost.
TEST(Guide, TracesControlVerticesInBodiesOftenEnough) {
    const Guide guide(best(Mode::Path, 0.0f), thickMedium(0.0f));
    const TimeBudget budget = outOf(0.3, 3.0, 5.0, 0.2);
    const Vec3 down = budget.axis * -1.0f;
    EXPECT_FLOAT_EQ(guide.shadowRayProbability(budget, down, {20.0f, 23.0f, 1.0f}, 0.08f), 0.1f);
    EXPECT_FLOAT_EQ(guide.shadowRayProbability(budget, budget.axis, {0.29f, 3.01f, 1.0f}, 0.08f), 1.0f);
    TimeBudget through = budget;
    through.model = EscapeModel::Infinite;
    EXPECT_EQ(guide.shadowRayProbability(through, down, {20.0f, 23.0f, 1.0f}, 0.08f), 1.0f);
}

/// In two whenever the length left has halved, however many vertices that takes.
TEST(Guide, SplitsWalksThatLeaveSoon) {
    const Guide guide(best(Mode::Path, 0.0f), thickMedium(0.0f)); // a mean free path is 0.1
    int copies = 1;
    SplittingSchedule splits;
    for (const double left : {3.0, 1.2, 1.3, 0.7, 0.15, 0.01, 0.001}) {
        const TimeBudget budget = outOf(0.001, 3.0, 3.0 + left, 0.2);
        copies *= splits.copies(guide.splits(budget));
        EXPECT_EQ(copies, left > 1.6 ? 1 : left > 0.8 ? 2 : left > 0.4 ? 4 : left > 0.1 ? 16 : 32) << left;
    }
    SplittingSchedule late; // little is left from the first vertex on: only the halvings after it count
    EXPECT_EQ(late.copies(guide.splits(outOf(0.001, 3.0, 3.7, 0.2))), 1);
    EXPECT_EQ(late.copies(guide.splits(outOf(0.001, 3.0, 3.01, 0.2))), 8);
    TimeBudget through = outOf(0.001, 3.0, 3.05, 0.2);
    through.model = EscapeModel::Infinite;
    EXPECT_EQ(guide.splits(through), 0);
}

TEST(FirstPassage, FacesAddUp) {
    TimeBudget budget = outOf(0.3, 3.0, 5.0, 0.2);
    const double one = logPassage(budget, 1.0f);
    budget.escape.faces.add(budget.escape.faces[0]);
    EXPECT_NEAR(logPassage(budget, 1.0f), one + std::log(2.0), 1e-5);
}

TEST(FirstPassage, PullsTowardsTheBoundaryAndInsideTheSides) {
    TimeBudget budget = outOf(0.3, 3.0, 5.0, 0.2);
    const EscapePoint<float> here(budget.escape, budget.latest(0), budget.axis, 0.0f);
    const FirstPassage::Slopes slopes =
        FirstPassage(float(SigmaA), float(ReducedS), budget.escape).slopes(here, budget.axis);
    EXPECT_GT(dot(slopes.pull, budget.escape.faces[0].normal), 0.9f * length(slopes.pull));
    // Too little time to get anywhere: straight out at great strength; plenty of time: hardly pulled.
    const TimeBudget hurried = outOf(1.0, 3.0, 4.3, 0.2), patient = outOf(1.0, 3.0, 40.0, 0.2);
    const auto strength = [](const TimeBudget& r) {
        const EscapePoint<float> place(r.escape, r.latest(0), r.axis, 0.0f);
        return length(FirstPassage(float(SigmaA), float(ReducedS), r.escape).slopes(place, r.axis).pull);
    };
    EXPECT_GT(strength(hurried), 3.0f * strength(patient));
    budget.escape.sides.add({{0, 1, 0}, 0.5f});
    for (int i = 1; i < 4; ++i) budget.escape.sides.add({{1, 0, 0}, -1.0f});
    const EscapePoint<float> beside(budget.escape, budget.latest(0), budget.axis, 0.0f);
    EXPECT_LT(FirstPassage(float(SigmaA), float(ReducedS), budget.escape).slopes(beside, budget.axis).pull.y, -0.1f);
}

/// Over a mean free path, in depth and in the length left: the target is straight above, where neither changes the
/// other.
TEST(FirstPassage, SlopesAreDifferences) {
    const double step = 1.0 / ReducedS;
    for (const auto& [depth, height, longest, gate] :
         {std::array{0.3, 3.0, 5.0, 0.2}, {1.0, 3.0, 4.3, 0.2}, {0.05, 1.0, 20.0, 1.0}}) {
        const TimeBudget budget = outOf(depth, height, longest, gate);
        const FirstPassage passage(float(SigmaA), float(ReducedS), budget.escape);
        const EscapePoint<float> here(budget.escape, budget.latest(0), budget.axis, 0.0f);
        const FirstPassage::Slopes slopes = passage.slopes(here, budget.axis);
        const double log = logPassage(budget, 1.0f);
        const double change = log - logPassage(outOf(depth + step, height, longest, gate), 1.0f);
        const double later = logPassage(outOf(depth, height, longest + step, gate), 1.0f) - log;
        EXPECT_NEAR(slopes.later, later / step, 0.01 + 0.01 * std::abs(later / step)) << depth;
        const double outward = (change > 0.0 ? change : std::expm1(change)) / step;
        EXPECT_NEAR(dot(slopes.pull, budget.escape.faces[0].normal), outward, 0.01 + 0.01 * std::abs(outward)) << depth;
    }
}

TEST(FirstPassage, RegistersAndSinglePlacesAgree) {
    TimeBudget budget = outOf(0.5, 2.0, 4.0, 0.3);
    budget.escape.faces[0].thickness = 1.5f;
    const FirstPassage passage(float(SigmaA), float(ReducedS), budget.escape);
    using Batch = xsimd::batch<float>;
    const Vec3 direction = directionAbout(budget.axis, 0.6f, 0.2f);
    const Ellipse<float> latest = budget.latest(0.6f);
    alignas(64) std::array<float, size_t(lanes::Width<Batch>)> along{}, logs{};
    for (size_t i = 0; i < along.size(); ++i) along[i] = latest.firstLeg() * float(i) / float(along.size());
    Batch factor;
    const Batch power = passage.exponent(
        EscapePoint<Batch>(budget.escape, latest, direction, Batch::load_unaligned(along.data()), 0.05f), factor);
    lanes::put(logs.data(), Batch(power + xsimd::log(factor)));
    for (size_t i = 0; i < along.size(); ++i)
        EXPECT_NEAR(logs[i], passage.log({budget.escape, latest, direction, along[i], 0.05f}), 1e-3f) << i;
}

} // namespace
} // namespace darts
