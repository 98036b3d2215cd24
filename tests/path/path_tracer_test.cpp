// The path tracer against closed forms and verified values.

#include "path/PathTracer.h"
#include "tungsten/core/Errors.h"
#include "tungsten/integrator/SceneFacts.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/PathsAndPhotons.h"
#include "support/SeedShift.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

using test::Rendered;
using test::RenderOptions;
using test::renderPaths;

struct OrderCase {
    test::VerifiedValue value;
    double slack; ///< relative allowance for the heavy tail of next-event estimation near the light (order 2 and up)
};

class PathOrders : public testing::TestWithParam<OrderCase> {};

TEST_P(PathOrders, MatchVerifiedValues) {
    const test::OtherSeeds seeds{{"A3WarpedBox", 1}};
    const OrderCase& c = GetParam();
    const auto rendered = renderPaths(test::sceneOf(c.value), {test::gateOf(c.value), 100, 20000});
    const double error = rendered->pixelError(), expected = c.value.radiance;
    EXPECT_NEAR(rendered->mean(), expected, 4.0 * error + c.slack * expected) << "standard error " << error;
    EXPECT_LT(error, 0.04 * expected) << "the test would not see a wrong value";
}

INSTANTIATE_TEST_SUITE_P(ConfigurationsAAndB, PathOrders,
                         testing::Values(OrderCase{test::verified("A1WarpedBox"), 0.0},
                                         OrderCase{test::verified("A2UnwarpedBox"), 0.02},
                                         OrderCase{test::verified("A3WarpedBox"), 0.03},
                                         OrderCase{test::verified("B2WarpedBox"), 0.03}),
                         [](const auto& test) { return tungsten::test::nameOf(test.param.value); });

TEST(PathTracer, SingleScatteringInAFoggedBox) {
    const auto rendered = renderPaths(test::foggedBox(), {{}, 40, 20000});
    const double expected = test::foggedBoxSingleScattering();
    EXPECT_NEAR(rendered->mean(), expected, 4.5 * rendered->pixelError());
    EXPECT_LT(rendered->pixelError(), 0.02 * expected);
}

TEST(PathTracer, DirectLightingAndItsArrivalTime) {
    const auto rendered = renderPaths(test::litFloor(20), {{}, 4, 16});
    // Light to floor 1.25, floor to camera 2, pulse at 0.6: time 3.85, in frame 15 of width 0.25.
    const double expected = 0.5 / 3.14159265358979 * 3.0 * (1.0 / 1.25) / (1.25 * 1.25) / 0.25;
    for (int frame = 0; frame < 20; ++frame)
        EXPECT_NEAR(rendered->mean(frame), frame == 15 ? expected : 0.0, 2e-3 * expected) << frame;
}

TEST(PathTracer, UnwarpedTimeLeavesOutTheCameraSegment) {
    const auto rendered = renderPaths(test::litFloor(20), {{"integrator.camera_unwarped=true"}, 4, 16});
    for (int frame = 0; frame < 20; ++frame) EXPECT_EQ(rendered->mean(frame) > 0.0, frame == 7) << frame; // 0.6 + 1.25
}

TEST(PathTracer, ConvexLambertInAUniformEnvironment) {
    const auto rendered = renderPaths(test::furnace(false), {{}, 8, 256});
    for (const Rgb& pixel : rendered->film.mean(0).pixels) EXPECT_NEAR(pixel.x, 0.3f, 0.003f);
}

TEST(PathTracer, CloudWithoutAbsorptionVanishesInAUniformEnvironment) {
    const auto rendered = renderPaths(test::furnace(true), {{}, 32, 512});
    const Image mean = rendered->film.mean(0), error = rendered->film.standardError(0);
    for (size_t i = 0; i < mean.pixels.size(); ++i) EXPECT_NEAR(mean.pixels[i].y, 1.0f, 5.0f * error.pixels[i].y);
    EXPECT_LT(error.pixels[5].y, 0.02f);
}

TEST(PathTracer, FramesSumToTheSteadyState) {
    const RenderOptions options{{}, 4, 64};
    const auto steady = renderPaths(test::fogOverFloor(test::SteadyState), options);
    const auto frames =
        renderPaths(test::fogOverFloor(R"("start_time": 0, "transient_time_width": 5, "frame_num": 30)"), options);
    // The same random numbers, so the same paths: equal but for rounding.
    const Image whole = steady->film.mean(0), mean = frames->film.meanOverFrames();
    for (size_t i = 0; i < whole.pixels.size(); ++i)
        EXPECT_NEAR(mean.pixels[i].y * 150.0f, whole.pixels[i].y, 1e-4f * whole.pixels[i].y + 1e-6f);
    EXPECT_GT(frames->mean(1), 0.0);
    EXPECT_GT(frames->mean(2), 0.0);
}

TEST(PathTracer, SameImageOnOneAndTwoThreadsBitForBit) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 8, "transient_time_width": 4)");
    const auto one = renderPaths(json, {{}, 3, 16, 7, 1}), two = renderPaths(json, {{}, 3, 16, 7, 2});
    EXPECT_EQ(one->film.mean(0).pixels, two->film.mean(0).pixels);
    EXPECT_GT(one->mean(), 0.0);
    EXPECT_NE(one->film.mean(0).pixels, renderPaths(json, {{}, 3, 16, 8, 2})->film.mean(0).pixels);
}

/// Compares 32 samples a pixel in passes of `few` with the same in passes of `many`. They are the same paths, so that
/// all counters are equal, and pixels are equal but for rounding: a pass sums in double and is rounded to floats once,
/// and each pass rounds the mean of all passes to one of the two neighbouring floats.
void expectSameSamples(const std::string& json, const std::vector<std::string>& overrides, uint32_t few,
                       uint32_t many) {
    constexpr uint32_t Samples = 32;
    const auto a = renderPaths(json, {overrides, Samples / few, few});
    const auto b = renderPaths(json, {overrides, Samples / many, many});
    EXPECT_EQ(a->statistics.counters(), b->statistics.counters());
    const float rounding = float(Samples / few + Samples / many + 1) * 0x1p-23f;
    double sum = 0.0;
    for (int frame = 0; frame < a->film.frames(); ++frame) {
        const Image expected = a->film.mean(frame), found = b->film.mean(frame);
        sum += a->mean(frame);
        for (size_t i = 0; i < expected.pixels.size(); ++i)
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(found.pixels[i][k], expected.pixels[i][k], rounding * expected.pixels[i][k])
                    << "frame " << frame << ", pixel " << i << ", channel " << k;
    }
    EXPECT_GT(sum, 0.0);
}

TEST(PathTracer, SamplesDoNotDependOnHowPassesAreCut) {
    const std::string steady = test::fogOverFloor(test::SteadyState),
                      gate = test::fogOverFloor(R"("transient_time_center": 8, "transient_time_width": 4)"),
                      film = test::fogOverFloor(R"("start_time": 4, "transient_time_width": 3, "frame_num": 3)"),
                      laser = test::withLaser(test::configurationA(2, false));
    const std::string black = R"(primitives.1.bsdf={"type": "null"})";
    for (const auto& [few, many] : {std::pair(1u, 32u), std::pair(4u, 16u)}) {
        // Passes of fewer than four samples give all pixels as many.
        const std::string best =
            few < 4 ? R"(integrator.darts={"preset": "best", "adaptive_samples": false})" : "integrator.darts=best";
        expectSameSamples(steady, {}, few, many);
        expectSameSamples(film, {}, few, many);
        expectSameSamples(laser, {}, few, many);
        expectSameSamples(gate, {"integrator.darts=published"}, few, many);
        expectSameSamples(laser, {best}, few, many);
        // Light vertices are each pass's own: a floor that scatters nothing has none.
        expectSameSamples(film, {best, black}, few, many);
    }
}

TEST(PathTracer, IndexMatchedBoundariesCountAsBounces) {
    // Into the cube, one scattering, out again: three interactions at least.
    const std::string json = test::fogOverFloor(test::SteadyState);
    const auto cut = [&](int maxBounces) {
        return renderPaths(json, {{"integrator.max_bounces=" + std::to_string(maxBounces),
                                   "primitives.1.bsdf={\"type\": \"null\"}"},
                                  2,
                                  64})
            ->mean();
    };
    EXPECT_EQ(cut(3), 0.0);
    EXPECT_GT(cut(4), 0.0);
}

TEST(PathTracer, CountersSayWhatHappened) {
    const auto rendered = renderPaths(test::fogOverFloor(test::SteadyState), {{}, 1, 4});
    EXPECT_EQ(rendered->statistics.counter("camera paths"), 16u * 16u * 4u);
    EXPECT_GT(rendered->statistics.counter("medium events"), 0u);
    EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
    const auto clear = renderPaths(test::litFloor(1), {{}, 1, 4});
    EXPECT_EQ(clear->statistics.counter("medium events"), 0u);
}

TEST(PathTracer, DeltaGatesAreRefusedWhereNoControlVertexCanMeetThem) {
    EXPECT_THROW(renderPaths(test::litFloor(1), {{"integrator.delta_time_gate=true"}, 1, 1}), InputError);
    const auto problem = [](std::vector<std::string> overrides) -> std::string {
        overrides.insert(overrides.end(), {"integrator.delta_time_gate=true", "integrator.frame_num=0"});
        try {
            renderPaths(test::fogOverFloor(test::SteadyState), {overrides, 1, 1});
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    const std::string best = "integrator.darts=best", black = R"(primitives.1.bsdf={"type": "null"})";
    EXPECT_NE(problem({"integrator.darts=off", black}).find("plain paths"), std::string::npos);
    EXPECT_NE(problem({R"(integrator.darts={"direction": "phase"})", "integrator.enable_elliptical=false", black})
                  .find("plain paths"),
              std::string::npos);
    EXPECT_NE(problem({best}).find("diffuse, glossy or emitting surfaces"), std::string::npos);
    EXPECT_NE(problem({best, black, "media.0.speed_of_light=0.5"}).find("different speeds"), std::string::npos);
    EXPECT_EQ(problem({best, black}), "");
}

/// Fog over a lit floor in a gate, guided.
std::unique_ptr<Rendered> renderGuided(const std::string& darts, RenderOptions options) {
    options.overrides.push_back("integrator.darts=" + darts);
    return renderPaths(test::fogOverFloor(R"("transient_time_center": 8, "transient_time_width": 4)"), options);
}

TEST(GuidedPaths, SameImageOnOneAndTwoThreadsBitForBit) {
    for (const std::string darts : {"best", R"({"plain_share": 0.5})"}) {
        const auto one = renderGuided(darts, {{}, 3, 16, 7, 1}), two = renderGuided(darts, {{}, 3, 16, 7, 2});
        EXPECT_EQ(one->film.mean(0).pixels, two->film.mean(0).pixels);
        EXPECT_GT(one->mean(), 0.0);
        EXPECT_NE(one->film.mean(0).pixels, renderGuided(darts, {{}, 3, 16, 8, 2})->film.mean(0).pixels);
    }
}

TEST(GuidedPaths, StagesThatAreOffCountNothing) {
    struct Counts {
        uint64_t controlVertices, lightCaches, lightConnections, reflectedLight;
    };
    const std::string Alone = R"({"plain_share": 0})"; // guided paths, whatever a pilot would choose
    const auto counts = [](const std::string& darts, std::vector<std::string> overrides = {}) {
        const auto rendered = renderGuided(darts, {std::move(overrides), 1, 8});
        const Statistics& statistics = rendered->statistics;
        return Counts{statistics.counter("control vertices"), statistics.counter("light paths"),
                      statistics.counter("light vertex connections"),
                      statistics.counter("glossy light vertex connections")};
    };
    const Counts best = counts(Alone);
    EXPECT_GT(best.controlVertices, 0u);
    EXPECT_GT(best.lightCaches, 0u);
    EXPECT_GT(best.lightConnections, 0u);
    EXPECT_EQ(best.reflectedLight, 0u) << "the floor is diffuse";
    const std::string glossy = R"(primitives.1.bsdf={"type": "rough_conductor", "material": "Au", "roughness": 0.2})";
    EXPECT_GT(counts(Alone, {glossy}).reflectedLight, 0u);
    EXPECT_EQ(counts("published", {glossy}).reflectedLight, 0u);
    EXPECT_EQ(counts(Alone, {"integrator.enable_elliptical=false"}).controlVertices, 0u);
    const std::string black = R"(primitives.1.bsdf={"type": "null"})";
    for (const Counts& c :
         {counts("published"), counts(Alone, {black}), counts(Alone, {"media.0.speed_of_light=0.5"}), counts("off")}) {
        EXPECT_EQ(c.lightCaches, 0u);
        EXPECT_EQ(c.lightConnections, 0u);
    }
    EXPECT_EQ(counts("off").controlVertices, 0u);
}

TEST(GuidedPaths, ThePlanSaysWhy) {
    const auto planned = [](const std::string& darts, const std::string& feature) {
        const test::SceneFile file(
            test::fogOverFloor(R"("transient_time_center": 8, "transient_time_width": 4, "darts": )" + darts));
        const LoadedScene loaded = loadScene(file.path(), {{}, {"integrator.type=path_tracer"}});
        SceneFacts facts = analyseScene(*loaded.scene);
        Features features = featuresOf(*loaded.scene, facts);
        PathTracer(loaded.scene, loaded.integratorSettings).plan(facts, features);
        for (const Feature& f : features.all)
            if (f.name == feature) return std::string(f.on ? "on: " : "off: ") + f.reason;
        return std::string();
    };
    EXPECT_EQ(planned(R"("best")", "guided paths"), "on: DARTS sampling of scattering media");
    EXPECT_EQ(planned(R"("published")", "guided paths"), "on: published DARTS sampling of scattering media");
    EXPECT_EQ(planned(R"("off")", "guided paths").substr(0, 4), "off:");
    EXPECT_EQ(planned(R"("best")", "light vertices").substr(0, 3), "on:");
    EXPECT_EQ(planned(R"("published")", "light vertices").substr(0, 4), "off:");
    EXPECT_EQ(planned(R"("best")", "glossy light vertices"), "off: no glossy surface");
}

TEST(PathTracer, SaysThatLightOfASingleDirectionIsMissedInView) {
    const auto warnings = [](const std::string& light) {
        const test::SceneFile file(R"({"primitives": [{"name": "beam", "emission": 1, )" + light +
                                   R"(, "transform": {"position": [0, 2, 0], "look_at": [0, 0, 0]}},
             {"type": "quad", "bsdf": {"type": "lambert"}, "transform": {"scale": 4}}],
            "camera": {"resolution": 1, "transform": {"position": [0, 2, 2], "look_at": [0, 0, 0]}},
            "integrator": {"type": "path_tracer"}})");
        const LoadedScene loaded = loadScene(file.path());
        SceneFacts facts = analyseScene(*loaded.scene);
        Features features = featuresOf(*loaded.scene, facts);
        PathTracer(loaded.scene, loaded.integratorSettings).plan(facts, features);
        const bool planned = std::any_of(features.all.begin(), features.all.end(), [](const Feature& feature) {
            return feature.name == "light of a single direction in view";
        });
        std::string text;
        for (const Problem& warning : loaded.diagnostics->warnings) text += warning.text();
        EXPECT_EQ(planned, text.find("paths miss") != std::string::npos);
        return text;
    };
    EXPECT_NE(warnings(R"("type": "collimated", "radius": 0.1)").find("'beam'"), std::string::npos);
    EXPECT_EQ(warnings(R"("type": "point")").find("paths miss"), std::string::npos);
}

} // namespace
} // namespace tungsten::path
