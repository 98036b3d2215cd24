// How many samples pixels get: by what was told of them, without gaps between passes, and without a change of means.

#include "path/PathTracer.h"
#include "path/SampleAllocation.h"

#include "support/SceneFile.h"

#include "tungsten/core/Random.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tungsten::path {
namespace {

constexpr Vec2i Size{8, 6};

/// Variance `variance(x, y)` and cost `cost(x, y)` of every pixel.
template <typename Variance, typename Cost>
SampleAllocation allocationOf(const Variance& variance, const Cost& cost, int rounds = 200) {
    SampleAllocation allocation(Size);
    for (int round = 0; round < rounds; ++round)
        for (size_t block = 0; block < allocation.blocks(); ++block) {
            const Vec2i pixel = allocation.pixelOf(block, 0.5f, 0.5f);
            allocation.tell(block, variance(pixel.x, pixel.y), cost(pixel.x, pixel.y));
        }
    allocation.choose();
    return allocation;
}

double densityOf(const SampleAllocation& allocation, int x, int y) {
    constexpr uint32_t Many = 1u << 20;
    return double(allocation.of(x, y, 0, Many).count) / double(Many);
}

TEST(SampleAllocation, EvenWhereNothingVaries) {
    const SampleAllocation nothing = allocationOf([](int, int) { return 0.0; }, [](int, int) { return 1.0; });
    for (const SampleAllocation& even : {nothing, SampleAllocation()}) {
        const auto samples = even.of(3, 2, 16, 8);
        EXPECT_EQ(samples.first, 16u);
        EXPECT_EQ(samples.count, 8u);
    }
}

/// In proportion to the root of variance over cost, but for rounding: left and right halves, far from where their
/// neighbourhoods meet.
TEST(SampleAllocation, IsNeymans) {
    const auto of = [](double variance, double cost) {
        const SampleAllocation allocation = allocationOf([=](int x, int) { return x < 4 ? 1.0 : variance; },
                                                         [=](int x, int) { return x < 4 ? 1.0 : cost; });
        return densityOf(allocation, 7, 3) / densityOf(allocation, 0, 3);
    };
    EXPECT_NEAR(std::log2(of(64.0, 1.0)), 3.0, 0.6) << "either half is rounded";
    EXPECT_NEAR(std::log2(of(16.0, 0.25)), 3.0, 0.6);
    EXPECT_NEAR(std::log2(of(1.0 / 64.0, 1.0)), -3.0, 0.6);
    EXPECT_NEAR(of(2.0, 1.0), std::sqrt(2.0), 0.1);
    EXPECT_EQ(of(1.2, 1.0), 1.0) << "would save 0.2 %";
    EXPECT_EQ(of(1e8, 1.0), 6.0) << "bounds: a quarter, and what an even image costs";
    EXPECT_EQ(of(1.0, 1.0), 1.0);
}

/// A single pair of each block: neighbours judge each other.
TEST(SampleAllocation, OneRoundIsEnough) {
    SampleAllocation allocation({32, 32});
    for (size_t block = 0; block < allocation.blocks(); ++block)
        allocation.tell(block, allocation.pixelOf(block, 0.5f, 0.5f).x < 16 ? 1.0 : 64.0, 1.0);
    allocation.choose();
    EXPECT_NEAR(std::log2(densityOf(allocation, 31, 16) / densityOf(allocation, 0, 16)), 3.0, 0.6);
}

TEST(SampleAllocation, CostsWhatAnEvenOneDoes) {
    const auto variance = [](int x, int y) { return std::pow(4.0, x) * (1.0 + y); };
    const auto cost = [](int x, int y) { return 1.0 + x * y; };
    const SampleAllocation allocation = allocationOf(variance, cost);
    double even = 0.0, taken = 0.0;
    for (int y = 0; y < Size.y; ++y)
        for (int x = 0; x < Size.x; ++x) {
            const double density = densityOf(allocation, x, y);
            EXPECT_GE(density, double(SampleAllocation::Least) - 1e-5);
            EXPECT_LE(density, double(SampleAllocation::Most) + 1e-5);
            even += cost(x, y);
            taken += density * cost(x, y);
        }
    EXPECT_NEAR(taken / even, 1.0, 0.05) << "but for rounding, and what neighbourhoods share";
}

/// What one half of the pairs makes of heavy tails the other half contradicts.
TEST(SampleAllocation, IsEvenWhereDifferencesAreNoise) {
    Sampler sampler(1, RandomStream::Pilot, 0, 0);
    const auto tails = [&](int, int) { return std::pow(1.0 - sampler.nextDouble(), -0.9); };
    const SampleAllocation allocation = allocationOf(
        tails, [](int, int) { return 1.0; }, 8);
    for (int y = 0; y < Size.y; ++y)
        for (int x = 0; x < Size.x; ++x) EXPECT_EQ(allocation.of(x, y, 0, 16).count, 16u);
}

/// Numbers of samples go on where the pass before has ended, however passes are cut.
TEST(SampleAllocation, LeavesNoGapsBetweenPasses) {
    const SampleAllocation allocation =
        allocationOf([](int x, int y) { return std::pow(4.0, x) + y; }, [](int, int) { return 1.0; });
    for (int x = 0; x < Size.x; ++x) {
        uint64_t first = 0, next = 0;
        for (const uint32_t count : {4u, 8u, 12u, 16u, 24u, 64u}) {
            const auto samples = allocation.of(x, 1, first, count);
            EXPECT_EQ(samples.first, next);
            EXPECT_GE(samples.count, 1u);
            next += samples.count;
            first += count;
        }
        EXPECT_EQ(next, allocation.of(x, 1, 0, uint32_t(first)).count) << "in one pass";
        EXPECT_EQ(double(next), double(first) * densityOf(allocation, x, 1)) << "a whole number of samples";
        const auto few = allocation.of(x, 1, first, 1);
        EXPECT_EQ(few.count, 1u) << "too few to be shared out";
        EXPECT_GT(few.first, 1u << 30) << "of numbers that no other pass has";
    }
}

struct Rendered {
    Film film;
    uint64_t pilot;
};
/// A ball of fog before a dark ground, with a lamp beside it.
Rendered render(const std::string& darts, uint32_t passes) {
    const test::SceneFile file(R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 4, "sigma_a": 1}],
        "camera": {"type": "pinhole", "fov": 40, "resolution": 12, "reconstruction_filter": "box",
                   "transform": {"position": [0, 0, -4]}},
        "primitives": [
            {"type": "sphere", "int_medium": "fog", "bsdf": {"type": "forward"}},
            {"type": "sphere", "emission": 10, "bsdf": {"type": "null"},
             "transform": {"position": [1.2, 0.6, -0.5], "scale": 0.2}}],
        "integrator": {"type": "path_tracer", "darts": )" +
                               darts +
                               R"(, "max_bounces": 32, "transient_time_center": 5, "transient_time_width": 1}})");
    const LoadedScene loaded = loadScene(file.path());
    PathTracer tracer(loaded.scene, loaded.integratorSettings);
    SceneFacts facts = analyseScene(*loaded.scene);
    Features features;
    tracer.plan(facts, features);
    Statistics statistics;
    tracer.prepare(facts, {}, statistics);
    Film film(12, 12, 1);
    for (uint32_t pass = 0; pass < passes; ++pass) {
        film.beginPass();
        tracer.renderPass({.index = pass, .firstSample = 8 * pass, .samples = 8, .seed = 5}, film, statistics);
        film.endPass(8.0);
    }
    return {std::move(film), statistics.counter("pilot samples")};
}

TEST(AllocatedSamples, KeepMeansAndLessenTheError) {
    constexpr const char *Uniform = R"({"preset": "best", "weight_windows": false, "adaptive_samples": false})",
                         *Best = R"({"preset": "best", "weight_windows": false})";
    const Rendered even = render(Uniform, 64), allocated = render(Best, 64);
    EXPECT_EQ(even.pilot, 0u);
    EXPECT_GT(allocated.pilot, 0u);
    const double mean = meanValue(even.film), pixels = 144.0;
    const double evenError = relativeStandardError(even.film) * mean / std::sqrt(pixels);
    const double error = relativeStandardError(allocated.film) * mean / std::sqrt(pixels);
    EXPECT_NEAR(meanValue(allocated.film), mean, 5.0 * std::hypot(error, evenError));
    EXPECT_LT(error, 0.95 * evenError);
}

TEST(AllocatedSamples, AreEvenInThePublishedMethodAndWithoutOne) {
    EXPECT_EQ(render(R"("published")", 1).pilot, 0u);
    EXPECT_EQ(render(R"("off")", 1).pilot, 0u);
}

} // namespace
} // namespace tungsten::path
