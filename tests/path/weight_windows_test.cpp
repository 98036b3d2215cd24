// Splitting and roulette of plain paths: the factors that are learned, and that no image depends on them.

#include "path/PathTracer.h"
#include "path/WeightWindows.h"

#include "guided_setup.h"

#include "tungsten/film/FilmErrors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tungsten::path {
namespace {

/// A ball of fog with a lamp beside it, and a gate about this time: at 8 most light has left it.
std::string fogBall(const std::string& time) {
    return R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 3, "sigma_a": 0.3}],
        "camera": {"type": "pinhole", "fov": 30, "resolution": 6, "reconstruction_filter": "box",
                   "transform": {"position": [0, 0, -4]}},
        "primitives": [
            {"type": "sphere", "int_medium": "fog", "bsdf": {"type": "forward"}},
            {"type": "sphere", "emission": 10, "bsdf": {"type": "lambert", "albedo": 0.5},
             "transform": {"position": [1.2, 0.6, -0.5], "scale": 0.2}}],
        "integrator": {"type": "path_tracer", "max_bounces": 64, "transient_time_width": 1,
                       "transient_time_center": )" +
           time + "}}";
}

/// Two ways on from a start: half of the paths go to `much`, where every other one finds 4, the others to `little`,
/// where every other one finds 1. In another unit of length, and delayed.
struct TwoWays {
    struct Place {
        float x;
        double time;
    };
    float unit = 1.0f;
    double delay = 0.0;
    Place start{0.0f, 1.0}, much{0.9f, 3.0}, little{-0.9f, 3.0};

    [[nodiscard]] WeightWindows learned(int pairs) const {
        WeightWindows windows;
        Sampler numbers(7, RandomStream::Pilot, 0, 0);
        for (int i = 0; i < pairs; ++i) {
            std::array<WeightWindows::Record, 2> pair;
            for (auto& [pilot, vertices] : pair) {
                pilot.begin(Strategy::Plain);
                const bool lucky = numbers.next1D() < 0.5f;
                for (const Place& at : {start, lucky ? much : little})
                    vertices.push_back({positionOf(at), timeOf(at), true, 1.0f, 0});
                if (numbers.next1D() < 0.5f) pilot.tell(lucky ? 4.0f : 1.0f, 0, 0.0f, Found::Aside);
            }
            windows.learn(pair);
        }
        windows.finish();
        return windows;
    }
    [[nodiscard]] WeightWindows::Factors at(const WeightWindows& windows, const Place& place,
                                            bool inMedium = true) const {
        return windows.factors(positionOf(place), timeOf(place), inMedium);
    }

  private:
    [[nodiscard]] Vec3f positionOf(const Place& at) const { return {unit * at.x, 0.0f, 0.0f}; }
    [[nodiscard]] double timeOf(const Place& at) const { return double(unit) * at.time + delay; }
};

/// In any unit, and however far from the start of times: cells are where paths are.
TEST(WeightWindows, FactorsAreRootsOfVarianceOverCost) {
    // Of what paths find: variance 17/4 - 25/16 for two vertices; then 8 - 4 and 1/2 - 1/4, squares of 8 and 1/2, for
    // one.
    const double start = std::sqrt((17.0 / 4.0 - 25.0 / 16.0) / 2.0);
    for (const TwoWays& ways : {TwoWays{}, TwoWays{.unit = 1e-3f, .delay = 5e4}, TwoWays{.unit = 1e6f}}) {
        const WeightWindows windows = ways.learned(40000);
        ASSERT_TRUE(windows.any());
        EXPECT_NEAR(ways.at(windows, ways.much).split, 2.0 / start, 0.03);
        EXPECT_NEAR(ways.at(windows, ways.much).survival, std::sqrt(8.0) / start, 0.03);
        EXPECT_NEAR(ways.at(windows, ways.little).split, 0.5 / start, 0.03);
        EXPECT_NEAR(ways.at(windows, ways.little).survival, std::sqrt(0.5) / start, 0.03);
        EXPECT_NEAR(ways.at(windows, ways.start).split, 1.0, 0.03);
        for (const bool inMedium : {true, false}) {
            const WeightWindows::Factors elsewhere = ways.at(windows, {0.3f, 2.0}, inMedium);
            EXPECT_EQ(elsewhere.split, 1.0f) << "where no path came";
            EXPECT_EQ(elsewhere.survival, 1.0f);
        }
        // No place is beyond the cells.
        EXPECT_EQ(ways.at(windows, {1e30f, 1e30}).split, ways.at(windows, ways.much).split);
        EXPECT_GT(windows.factors(Vec3f(std::nanf("")), double(Infinity), false).split, 0.0f);
    }
}

TEST(WeightWindows, AreNoneWhereLittleIsFound) {
    EXPECT_FALSE(TwoWays{}.learned(8).any());
}

/// Of many plain paths, by whatever windows.
PixelMean meanOf(const GuidedSetup& setup, const WeightWindows* windows) {
    PathContext context = setup.plain();
    context.windows = windows;
    return meanOfPaths(setup, 300, 400, [&](PixelAccumulator& sink, PathCounters& counters, uint32_t i) {
        Sampler sampler(3, RandomStream::Camera, i, 0);
        const Ray ray = setup.scene.camera.generateRay({3, 3}, sampler.next2D(), sampler.next2D());
        tracePath<true, true>(context, sink, counters, sampler, nullptr, ray);
    });
}

/// Windows that were learned from what no path finds: the left is worth much, the right nothing, and all is late.
TEST(WeightWindows, ImagesDoNotDependOnThem) {
    const GuidedSetup setup(fogBall("5.5"));
    const WeightWindows wrong = TwoWays{}.learned(40000);
    const PixelMean plain = meanOf(setup, nullptr), windowed = meanOf(setup, &wrong);
    EXPECT_LT(plain.error, 0.02 * plain.mean);
    EXPECT_NEAR(windowed.mean, plain.mean, 4.5 * std::hypot(plain.error, windowed.error));
    EXPECT_NE(windowed.mean, plain.mean) << "they were used";
}

struct WindowedRender {
    Film film;
    uint64_t windowed, pilot;
};
WindowedRender renderWith(const std::string& darts) {
    const test::SceneFile file(fogBall("7"));
    const LoadedScene loaded =
        loadScene(file.path(), {{}, {"camera.resolution=16", "media.*.sigma_s=6", "integrator.darts=" + darts}});
    PathTracer tracer(loaded.scene, loaded.integratorSettings);
    SceneFacts facts = analyseScene(*loaded.scene);
    Features features;
    tracer.plan(facts, features);
    Film film(16, 16, 1);
    Statistics statistics;
    tracer.prepare(facts, {}, statistics);
    for (uint32_t pass = 0; pass < 40; ++pass) {
        film.beginPass();
        tracer.renderPass({.index = pass, .firstSample = 16 * pass, .samples = 16, .seed = 5}, film, statistics);
        film.endPass(16.0);
    }
    return {std::move(film), statistics.counter("camera paths with weight windows"),
            statistics.counter("pilot paths of weight windows")};
}

TEST(WindowedPaths, KeepTheMeanAndLessenTheError) {
    constexpr const char *Best = R"({"preset": "best", "plain_share": 1, "adaptive_samples": false})",
                         *Without = R"({"preset": "best", "adaptive_samples": false, "weight_windows": false})";
    const WindowedRender with = renderWith(Best), without = renderWith(Without), plain = renderWith(R"("off")");
    EXPECT_GT(with.windowed, 0u);
    EXPECT_EQ(without.pilot, 0u);
    EXPECT_EQ(plain.pilot, 0u);
    const double mean = meanValue(plain.film);
    const auto errorOf = [&](const WindowedRender& of) {
        return relativeStandardError(of.film) * meanValue(of.film) / 16.0;
    };
    EXPECT_NEAR(meanValue(with.film), mean, 4.5 * std::hypot(errorOf(with), errorOf(plain)));
    EXPECT_LT(errorOf(with), 0.9 * errorOf(plain));
}

TEST(WindowedPaths, AreNotTakenBesideGuidedOnes) {
    const WindowedRender beside = renderWith(R"({"preset": "best", "plain_share": 0.5})");
    EXPECT_EQ(beside.pilot, 0u);
    EXPECT_EQ(renderWith(R"("published")").pilot, 0u);
}

} // namespace
} // namespace tungsten::path
