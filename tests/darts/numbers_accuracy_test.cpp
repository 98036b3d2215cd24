// Small functions against 50 digits: exponentials and logarithms of floats and registers, gates and frames, what
// boundaries reflect, phase functions as they are drawn.

#include "darts/FastMath.h"
#include "darts/Guide.h"

#include "support/Exact.h"
#include "support/LogUniform.h"

#include "tungsten/core/Random.h"

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;
using tungsten::test::Exact;
using tungsten::test::ExactPi;
using tungsten::test::LargestError;
using tungsten::test::logUniform;

TEST(NumbersAccuracy, ExponentialsAndLogarithms) {
    LargestError expm1s("fastExpm1"), log1ps("fastLog1p"), exps("registers_exp"), logs("registers_log");
    using Batch = xsimd::batch<float>;
    const auto first = [](const Batch& b) {
        alignas(64) std::array<float, size_t(lanes::Width<Batch>)> values{};
        lanes::put(values.data(), b);
        return double(values[0]);
    };
    for (uint64_t i = 0; i < 4000; ++i) {
        Sampler s(41, RandomStream::Test, 0, i);
        const float sign = i % 2 == 0 ? 1.0f : -1.0f;
        const auto x = sign * float(logUniform(s, 1e-9, 80.0)), above = float(logUniform(s, 1e-9, 1e9)),
                   below = -float(std::min(logUniform(s, 1e-9, 1.0), 1.0 - 1e-6));
        expm1s.add(double(fastExpm1(x)), expm1(Exact(x)));
        log1ps.add(double(fastLog1p(above)), log1p(Exact(above)));
        log1ps.add(double(fastLog1p(below)), log1p(Exact(below)));
        exps.add(first(lanes::exp(Batch(x))), exp(Exact(x)));
        const auto any = float(logUniform(s, 1.2e-38, 3e38));
        const auto near = 1.0f + 0.3f * x / 80.0f;
        for (const float y : {any, near})
            if (y != 1.0f) logs.add(first(lanes::log(Batch(y))), log(Exact(y)));
    }
    EXPECT_TRUE(expm1s.within(4e-7));
    EXPECT_TRUE(log1ps.within(4e-7));
    EXPECT_TRUE(exps.within(4e-7));
    EXPECT_TRUE(logs.within(1.5e-7));
    EXPECT_EQ(lanes::log(Batch(1.0f)).get(0), 0.0f);
}

/// Of unpolarised light that comes evenly from all directions out of the denser medium, from outside into it: Walsh
/// 1926, n > 1.
Exact reflectedFromOutside(const Exact& n) {
    const Exact n2 = n * n, n4 = n2 * n2, plus = n2 + 1, minus = n2 - 1;
    return Exact(0.5) + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * minus * minus / (plus * plus * plus) * log((n - 1) / (n + 1)) -
           2 * n2 * n * (n2 + 2 * n - 1) / (plus * (n4 - 1)) +
           8 * n4 * (n4 + 1) / (plus * (n4 - 1) * (n4 - 1)) * log(n);
}

/// A = (1 + R) / (1 - R) of a fit within 0.002 from 1 / 2 to 2; beyond, where the fit would leave [0, 1], in closed
/// form.
TEST(NumbersAccuracy, WhatBoundariesReflect) {
    LargestError reflectance("reflectance"), mismatch("mismatch"), beyond("mismatch_beyond");
    for (uint64_t i = 0; i < 600; ++i) {
        Sampler s(42, RandomStream::Test, 0, i);
        const auto n = float(i % 2 == 0 ? logUniform(s, 0.5, 2.0) : logUniform(s, 0.05, 20.0));
        if (n == 1.0f) continue;
        const Exact N(n), outside = reflectedFromOutside(n > 1.0f ? N : Exact(1 / N));
        const Exact exact = n > 1.0f ? Exact(1 - (1 - outside) / (N * N)) : outside;
        const auto A = double(boundaryReflectionA(n));
        const bool fitted = n >= 0.5f && n <= 2.0f;
        if (fitted) reflectance.add((A - 1.0) / (A + 1.0), exact, Exact(1));
        (fitted ? mismatch : beyond).add(A, (1 + exact) / (1 - exact));
    }
    EXPECT_TRUE(reflectance.within(3e-3));
    EXPECT_TRUE(mismatch.within(6e-3));
    EXPECT_TRUE(beyond.within(1.2e-7));
}

TEST(NumbersAccuracy, GatesFramesAndMedia) {
    LargestError range("range"), frames("frames"), reduced("reduced"), persistenceLength("persistence");
    for (uint64_t i = 0; i < 2000; ++i) {
        Sampler s(43, RandomStream::Test, 0, i);
        const double begin = logUniform(s, 1e-3, 1e5), width = begin * logUniform(s, 1e-7, 10.0),
                     elapsed = begin * s.nextDouble(), speed = logUniform(s, 1e-3, 1e3);
        const LengthInterval left = LengthInterval::of({begin, begin + width}, elapsed, speed);
        range.add(left.low, Exact(speed) * (Exact(begin) - elapsed));
        range.add(left.high, Exact(speed) * (Exact(begin + width) - elapsed));
        const FrameSequence sequence{begin, width, 10000};
        const int frame = int(s.nextDouble() * 10000);
        const Exact start = Exact(begin) + Exact(width) * frame, end = start + width;
        frames.add(sequence.frame(frame).begin, start);
        frames.add(sequence.frame(frame).end, end);
        const Medium medium{{0, 0, 0},
                            {float(logUniform(s, 1e-6, 1e4)), float(logUniform(s, 1e-6, 1e4)), 0.5f},
                            (i % 2 == 0 ? 0.999f : -0.999f) * s.next1D()};
        const Exact mean = (Exact(medium.sigmaS.x) + medium.sigmaS.y + medium.sigmaS.z) / 3,
                    exactly = mean * (1 - Exact(medium.g));
        reduced.add(double(medium.reducedSigmaS()), exactly);
        persistenceLength.add(double(medium.persistenceLength()), medium.g / exactly);
    }
    EXPECT_TRUE(range.within(4e-16));
    EXPECT_TRUE(frames.within(2.5e-16));
    EXPECT_TRUE(reduced.within(4e-7));
    EXPECT_TRUE(persistenceLength.within(4e-7));
}

/// Drawn angles have the rounding of floats of unit vectors, which moves h by 1e-7 sqrt(2 h).
TEST(NumbersAccuracy, PhaseFunctionsAsTheyAreDrawn) {
    LargestError drawn("henyeyGreenstein");
    for (uint64_t i = 0; i < 4000; ++i) {
        Sampler s(44, RandomStream::Test, 0, i);
        const float strength = s.next1D() < 0.1f ? 0.9999f : float(logUniform(s, 1e-6, 0.999));
        const float u = s.next1D() < 0.1f ? 0.0f : s.next1D(), v = s.next1D();
        const Vec3 before = directionAbout({0, 0, 1}, 2.0f * s.next1D(), s.next1D());
        const Vec3 after = HenyeyGreenstein{before, i % 2 == 0 ? strength : -strength}.sample(u, v);
        const Vec3 peak = i % 2 == 0 ? before : -before;
        const auto dotOf = [](const Vec3& a, const Vec3& b) {
            return Exact(Exact(a.x) * b.x + Exact(a.y) * b.y + Exact(a.z) * b.z);
        };
        const Exact found = 1 - dotOf(peak, after) / sqrt(dotOf(peak, peak) * dotOf(after, after));
        const Exact g(strength), root = (1 - g * g) / (1 - g + 2 * g * u),
                                 exact = 1 - (1 + g * g - root * root) / (2 * g);
        drawn.add(double(found), exact, sqrt(exact) + Exact(1e-7));
    }
    EXPECT_TRUE(drawn.within(6e-7));
}

/// Where the answer in floats is far from trivial: products of logarithms, and gates that end before they begin.
TEST(NumbersAccuracy, UsefulnessOfWalks) {
    LargestError useful("logExpectedContribution"), survival("survival"), limited("beforeSurface");
    for (uint64_t i = 0; i < 1500; ++i) {
        Sampler s(45, RandomStream::Test, 0, i);
        const double scale = logUniform(s, 1e-4, 1e5), depth = logUniform(s, 1e-3, 1e3);
        const auto C = float(scale), excess = float(scale * logUniform(s, 1e-6, 10.0));
        const double S = double(C) + double(excess), width = S * logUniform(s, 1e-7, 1.0);
        const auto a = float(depth / S * s.nextDouble()), b = float(depth / S * (0.01 + s.nextDouble()));
        const Medium medium{{a, a, a}, {b, b, b}, 0.9f * s.next1D()};
        const TimeBudget budget = TimeBudget::of({0, 0, C}, {S - width, S});
        const float throughput = float(logUniform(s, 1e-6, 1e3));
        Settings settings = best(Mode::Path, 0.0f);
        settings.greens = i % 2 == 0 ? Greens::Diffusion : Greens::Causal;
        const Guide guide(settings, medium);
        const Exact length = Exact(budget.C) + budget.excess, sigmaA(a), l = 1 / (b * (1 - Exact(medium.g)));
        const Exact fourDs = 4 * length / (3 * (sigmaA + 1 / l)), rho(budget.C);
        const Exact u = 1 - rho * rho / (length * length), x = length / l * pow(u, Exact(0.75));
        const Exact phi = i % 2 == 0 ? Exact(-1.5 * log(ExactPi * fourDs) - rho * rho / fourDs)
                                     : Exact(log(u) / 8 - 1.5 * log(4 * ExactPi * l * length / 3) - length / l + x +
                                             log(1 + Exact(2.026) / x) / 2);
        const Exact least = 1e-6 * length, reach = std::min(Exact(budget.excess), std::max(Exact(budget.width), least));
        const Exact exact = log(throughput * reach) + phi - sigmaA * length;
        const float found = guide.logExpectedContribution(budget, throughput);
        useful.add(double(found), exact, 1 + abs(exact));
        const float first = found + 4.0f * s.next1D();
        survival.add(double(guide.survival(EscapeModel::Infinite, found, first)),
                     std::min(Exact(1), Exact(exp(Exact(found) - first) / guide.settings().roulette)));
        const float h = float(logUniform(s, 1e-9, 2.0)), surface = s.next1D() * budget.latest(h).firstLeg();
        const Exact toTarget = sqrt(Exact(surface) * surface - 2 * surface * rho * (1 - Exact(h)) + rho * rho);
        const Exact beyond = length - surface - toTarget, exactly = budget.width - beyond;
        limited.add(double(Guide::beforeSurface(budget, h, surface).width), exactly > 0 ? exactly : Exact(0),
                    Exact(budget.width) + beyond);
    }
    EXPECT_TRUE(useful.within(3e-6));
    EXPECT_TRUE(survival.within(2e-7));
    EXPECT_TRUE(limited.within(1.2e-7));
}

} // namespace
} // namespace darts
