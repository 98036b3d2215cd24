// Ways out of bodies against 50 digits, from the formulas of docs/method.md, section 10.1, with all their differences
// and error functions: depths from 1e-3 to 1e3 mean free paths, targets on the boundary and far beyond it, gates of
// 1e-6 of the length, slabs, albedos from 0.1 to 1.

#include "darts/FirstPassage.h"

#include "support/Exact.h"
#include "support/LogUniform.h"

#include "tungsten/core/Random.h"

#include <boost/math/special_functions/erf.hpp>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;
using tungsten::test::Exact;
using tungsten::test::LargestError;
using tungsten::test::logUniform;

Vec3 anyDirection(Sampler& s) {
    return directionAbout({0, 0, 1}, 2.0f * s.next1D(), s.next1D());
}
Exact dotExactly(const Vec3& a, const Vec3& b) {
    return Exact(a.x) * b.x + Exact(a.y) * b.y + Exact(a.z) * b.z;
}

/// A flight in a body that has to be left.
struct Configuration {
    float sigmaA, reducedS, allowance, persistenceLength;
    Ellipse<float> latest;
    Vec3 direction;
    float along;
    EscapeGeometry escape;

    /// Faces whose normals the target is before, as rho has it; `sides`: of what the target sees.
    explicit Configuration(uint64_t i, int faces = 1, bool sides = false) {
        Sampler s(21, RandomStream::Test, 0, i);
        const double mfp = logUniform(s, 1e-3, 1e3);
        reducedS = float(1.0 / mfp);
        sigmaA = s.next1D() < 0.2f ? 0.0f : float(logUniform(s, 1e-4, 10.0) / mfp);
        allowance = s.next1D() < 0.5f ? 1.0f : 0.5f;
        persistenceLength = s.next1D() < 0.5f ? 0.0f : float(mfp * logUniform(s, 0.01, 100.0));
        const double depth = mfp * logUniform(s, 1e-3, 1e3);
        const double height = s.next1D() < 0.1f ? 0.0 : depth * logUniform(s, 1e-3, 1e3);
        const double lateral = s.next1D() < 0.1f ? 0.0 : depth * logUniform(s, 1e-3, 1e2);
        // Depth is along z, the target to the side along x.
        const Vec3 target{float(lateral), 0, float(depth + height)};
        direction = anyDirection(s);
        latest.C = length(target);
        latest.h = oneMinusCosine(direction, target * (1.0f / latest.C));
        latest.delta = float((depth + mfp) * logUniform(s, 1e-3, 1e3));
        along = s.next1D() * latest.firstLeg();
        escape.gate = float(double(latest.delta) * logUniform(s, 1e-6, 2.0));
        escape.reflectionA = s.next1D() < 0.5f ? 1.0f : float(logUniform(s, 1.0, 90.0));
        escape.extraLength = s.next1D() < 0.8f ? 0.0f : (s.next1D() < 0.5f ? 0.1f : 2.0f) * latest.delta;
        escape.outerSpeed = s.next1D() < 0.5f ? 1.0f : 0.5f + s.next1D();
        const float wall = s.next1D() < 0.5f ? EscapeGeometry::Infinite : float(depth * logUniform(s, 1.01, 100.0));
        const float beyond = s.next1D() < 0.7f ? 0.0f : float(mfp * s.nextDouble());
        escape.faces.add({{0, 0, 1}, float(depth), float(height), wall, beyond});
        const float part = s.next1D();
        if (faces > 1 && lateral > 0.0)
            escape.faces.add({{1, 0, 0}, part * target.x, (1.0f - part) * target.x, EscapeGeometry::Infinite, 0.0f});
        for (int k = 0; sides && k < 4; ++k)
            escape.sides.add({k < 2 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, float(depth) * (2.0f * s.next1D() - 1.0f)});
    }
    [[nodiscard]] FirstPassage passage() const { return {sigmaA, reducedS, escape, allowance}; }
    [[nodiscard]] EscapePoint<float> departure() const { return {escape, latest, direction, along, persistenceLength}; }
};

/// The same place and its chances, as the formulas have them.
struct ExactPassage {
    const Configuration& c;
    Exact rho, excess, squaredOutside = 0, meanFreePath, fourthInverseD, margin;
    struct RemainingLength {
        Exact depth, longest, reachable;
    };

    explicit ExactPassage(const Configuration& configuration) : c(configuration) {
        const Exact C(c.latest.C), d(c.along);
        rho = sqrt(d * d - 2 * d * C * (1 - Exact(c.latest.h)) + C * C);
        excess = C + c.latest.delta - d - rho - c.escape.extraLength;
        for (size_t i = 0; i < c.escape.sides.size(); i += 2) {
            const EscapeGeometry::Side &a = c.escape.sides[i], &b = c.escape.sides[i + 1];
            const Exact toA = a.outside + d * dotExactly(c.direction, a.normal),
                        toB = b.outside + d * dotExactly(c.direction, b.normal);
            const Exact outside = positive(toA > toB ? toA : toB);
            squaredOutside += outside * outside;
        }
        meanFreePath = 1 / Exact(c.reducedS);
        fourthInverseD = Exact(3) / 4 * (Exact(c.sigmaA) + c.reducedS);
        margin = c.escape.reflectionA / (2 * fourthInverseD);
    }
    static Exact positive(const Exact& x) { return x > 0 ? x : Exact(0); }
    static Exact least(const Exact& a, const Exact& b) { return a < b ? a : b; }
    static Exact most(const Exact& a, const Exact& b) { return a > b ? a : b; }

    [[nodiscard]] RemainingLength to(const EscapeGeometry::Face& face) const {
        const Exact cosine = dotExactly(c.direction, face.normal);
        Exact depth = positive(face.depth - c.along * cosine);
        const Exact outside = sqrt(positive(rho * rho - depth * (depth + 2 * Exact(face.height))));
        const Exact gained = positive(outside * (1 - Exact(c.escape.outerSpeed))), inTime = positive(excess + gained);
        const Exact longest = positive(inTime - gained + rho - outside * c.escape.outerSpeed);
        if (c.persistenceLength > 0)
            depth = positive(depth - cosine * c.persistenceLength * -expm1(-longest / c.persistenceLength));
        const Exact reachable = least(most(inTime, c.escape.gate * Exact(0.01f)), least(longest, c.escape.gate));
        return {depth, longest, reachable};
    }
    /// The part that has left after the length s from the depth z.
    [[nodiscard]] Exact leftBy(const Exact& z, const Exact& s) const {
        const Exact p = z * sqrt(fourthInverseD / s), w = sqrt(s / (4 * fourthInverseD)) / margin;
        return erfc(p) - exp(2 * p * w + w * w) * erfc(p + w);
    }
    [[nodiscard]] Exact through(const EscapeGeometry::Face& face, const RemainingLength& left) const {
        const Exact z = left.depth + face.outerDepth, end = left.longest + c.allowance * meanFreePath;
        const Exact shortest = left.longest - left.reachable;
        const Exact start = most(shortest * (1 + c.allowance * meanFreePath / (shortest + meanFreePath)), end / 10000);
        Exact chance = leftBy(z, end) - leftBy(z, start);
        if (face.thickness < EscapeGeometry::Infinite) {
            const Exact slab = face.thickness + 2 * margin + face.outerDepth, wall = most(slab - margin - z, margin);
            chance *= most(-expm1(-4 * fourthInverseD * slab * wall / end), Exact(1e-6f));
        }
        return chance * exp(-c.sigmaA * left.longest);
    }
    /// `deeper`, `later`: by so much than it is.
    [[nodiscard]] Exact throughFace(size_t i, const Exact& deeper, const Exact& later) const {
        RemainingLength left = to(c.escape.faces[i]);
        left.depth += deeper;
        left.longest += later;
        return through(c.escape.faces[i], left);
    }
    [[nodiscard]] Exact chance() const {
        Exact sum = 0;
        for (size_t i = 0; i < c.escape.faces.size(); ++i) sum += throughFace(i, 0, 0);
        sum *= exp(-squaredOutside * fourthInverseD / (positive(excess) + meanFreePath));
        return sum;
    }
};

TEST(FirstPassageAccuracy, Departures) {
    LargestError rho("rho"), excess("excess"), outside("outside"), depth("depth"), longest("longest"),
        reachable("reachable"), fasterOutside("reachable where light is faster outside");
    for (uint64_t i = 0; i < 4000; ++i) {
        const Configuration c(i, 1, true);
        const ExactPassage exact(c);
        const EscapePoint<float> at = c.departure();
        const Exact whole = Exact(c.latest.C) + c.latest.delta;
        rho.add(double(at.rho), exact.rho);
        excess.add(double(at.excess), exact.excess, Exact(c.latest.delta));
        outside.add(double(at.squaredOutside), exact.squaredOutside, exact.squaredOutside + whole * whole);
        const auto left = at.to(c.escape.faces[0]);
        const auto exactly = exact.to(c.escape.faces[0]);
        depth.add(double(left.depth), exactly.depth, Exact(c.escape.faces[0].depth) + c.along + c.persistenceLength);
        // Of targets on the boundary the way outside is a root of a difference.
        longest.add(double(left.longest), exactly.longest, exact.excess + exact.rho);
        if (c.escape.outerSpeed < 1.0f) // a difference of lengths
            fasterOutside.add(double(left.reachable), exactly.reachable, exact.rho);
        else
            reachable.add(double(left.reachable), exactly.reachable, Exact(c.escape.gate));
    }
    EXPECT_TRUE(rho.within(2.5e-7));
    EXPECT_TRUE(excess.within(1e-6));
    EXPECT_TRUE(outside.within(1.2e-7));
    EXPECT_TRUE(depth.within(5e-6));
    EXPECT_TRUE(longest.within(1.5e-4));
    EXPECT_TRUE(reachable.within(3e-5));
    EXPECT_TRUE(fasterOutside.within(5e-6));
}

TEST(FirstPassageAccuracy, ProbabilitiesOfHalfSpacesAndSlabs) {
    LargestError likely("likely"), rare("rare"), registers("registers");
    using Batch = xsimd::batch<float>;
    for (uint64_t i = 0; i < 800; ++i) {
        const Configuration c(i, 1 + int(i % 2), i % 3 == 0);
        const Exact chance = ExactPassage(c).chance(), exactly = log(chance);
        const auto found = double(c.passage().log(c.departure()));
        if (exactly > -10)
            likely.add(found, exactly, Exact(1));
        else
            rare.add(found, exactly);
        Batch factor(0.0f);
        const Batch power = c.passage().exponent(
            EscapePoint<Batch>(c.escape, c.latest, c.direction, Batch(c.along), c.persistenceLength), factor);
        alignas(64) std::array<float, size_t(lanes::Width<Batch>)> logs{}, factors{};
        lanes::put(logs.data(), power);
        lanes::put(factors.data(), factor);
        registers.add(double(logs[0]) + std::log(double(factors[0])), exactly, Exact(1) + abs(exactly));
    }
    EXPECT_TRUE(likely.within(0.01));
    EXPECT_TRUE(rare.within(4e-4));
    EXPECT_TRUE(registers.within(3e-3));
}

/// The gradient's differences over a mean free path, as FirstPassage::slopes has them.
TEST(FirstPassageAccuracy, Slopes) {
    LargestError pull("pull"), later("later");
    for (uint64_t i = 0; i < 300; ++i) {
        Configuration c(i);
        const ExactPassage exact(c);
        const Exact step = exact.meanFreePath, here = log(exact.throughFace(0, 0, 0));
        const Exact change = here - log(exact.throughFace(0, step, 0)),
                    inTime = (log(exact.throughFace(0, 0, step)) - here) / step;
        const Exact outward = (change > 0 ? change : Exact(expm1(change))) / step;
        const FirstPassage::Slopes slopes = c.passage().slopes(c.departure(), {0, 0, 1});
        const Exact scale = (1 + abs(here)) / step;
        pull.add(double(slopes.pull.z), outward, scale);
        later.add(double(slopes.later), inTime, scale);
    }
    EXPECT_TRUE(pull.within(3e-3));
    EXPECT_TRUE(later.within(3e-3));
}

} // namespace
} // namespace darts
