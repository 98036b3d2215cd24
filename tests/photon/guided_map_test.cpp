// Guided light paths in whole scenes: sequences, several pulses, full stores, threads.

#include "photon/light/PhotonPass.h"
#include "tungsten/integrator/SceneFacts.h"
#include "tungsten/scene/Scene.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/Folders.h"
#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using test::expectSameBlocks;
using test::GuidedAlone;
using test::Overrides;
using test::PublishedPreset;
using test::renderBeams;
using test::Rendered;
using test::renderPaths;
using test::renderPhotons;
using test::setting;

struct MapCase {
    const char* name;
    std::string darts;
    bool beams;
};
class GuidedMaps : public testing::TestWithParam<MapCase> {
  protected:
    /// Guided as the case says.
    [[nodiscard]] static std::unique_ptr<Rendered> guided(const std::string& json, test::RenderOptions options) {
        options.overrides.push_back(GetParam().darts);
        return GetParam().beams ? renderBeams(json, options) : renderPhotons(json, options);
    }
};

INSTANTIATE_TEST_SUITE_P(Presets, GuidedMaps,
                         testing::Values(MapCase{"PublishedPoints", PublishedPreset, false},
                                         MapCase{"BestPoints", GuidedAlone, false},
                                         MapCase{"PublishedBeams", PublishedPreset, true},
                                         MapCase{"BestBeams", GuidedAlone, true}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(GuidedMaps, SingleScatteringInAFoggedBox) {
    const auto rendered = guided(
        test::foggedBox(),
        {{setting("volume_gather_radius", 0.05), setting("photon_count", GetParam().beams ? 8000 : 25000)}, 60, 1});
    const double expected = test::foggedBoxSingleScattering();
    EXPECT_NEAR(rendered->mean(), expected, 4.0 * rendered->pixelError() + 0.01 * expected);
    EXPECT_LT(rendered->pixelError(), 0.08 * expected);
}

/// Two pulses, 2 apart in time; fog, floor, a boundary between them. Frames see one pulse or both.
TEST_P(GuidedMaps, AgreeWithPathsInEveryFrame) {
    const std::string json = test::fogOverFloor(R"("start_time": 6, "transient_time_width": 2, "frame_num": 3)");
    const auto photons = GetParam().darts == GuidedAlone ? guided(json, {{setting("photon_count", 12000)}, 20, 1})
                                                         : guided(json, {{setting("photon_count", 24000)}, 40, 1});
    const auto paths = renderPaths(json, {{}, 20, 64});
    for (int frame = 0; frame < 3; ++frame) expectSameBlocks(*photons, *paths, frame, 0.05, 0.25);
    EXPECT_EQ(photons->statistics.counter("non-finite samples"), 0u);
}

/// Through a lens as wide as the gate: guided paths must also find what arrives in time at its near side alone.
TEST(GuidedThroughALens, FindAllLightInTheGate) {
    const Overrides lens{R"(camera.type="thinlens")",
                         "camera.fov=0.001",
                         "camera.focus_distance=2",
                         "camera.aperture_size=0.5",
                         setting("transient_time_center", 4.5),
                         setting("transient_time_width", 0.4)};
    for (const int order : {1, 2}) {
        const auto mean = [&](const std::string& darts, double paths) {
            Overrides all = lens;
            all.push_back("integrator.darts=" + darts);
            all.push_back(setting("photon_count", paths));
            return renderPhotons(test::configurationA(order, false), {all, 60, 8});
        };
        const auto plain = mean("off", 20000), best = mean("best", 5000);
        const double error = std::hypot(plain->pixelError(), best->pixelError());
        EXPECT_NEAR(best->mean(), plain->mean(), 4.5 * error) << order;
        EXPECT_LT(error, 0.15 * plain->mean()) << order << ": the test would not see a wrong value";
    }
}

/// 10 paths cannot aim at 7 frames equally often in one pass, only over passes.
TEST(GuidedFrames, NeedNotDivideThePaths) {
    const test::SceneFile file(test::fogOverFloor(R"("start_time": 6, "transient_time_width": 0.5, "frame_num": 7)"));
    const auto countByFrame = [&](int paths, uint32_t passes) {
        const LoadedScene loaded = loadScene(
            file.path(), {{}, {setting("photon_count", paths), R"(integrator.darts={"single_frames": true})"}});
        const PhotonSettings settings = readPhotonSettings(loaded.integratorSettings, *loaded.scene, true);
        const PhotonPass photonPass(*loaded.scene, settings,
                                    PhotonPlan::of(*loaded.scene, settings, analyseScene(*loaded.scene)));
        std::array<double, 7> counts{};
        Statistics statistics;
        for (uint32_t index = 0; index < passes; ++index) {
            const PhotonMaps maps = photonPass.trace({index, index, 1, 5}, nullptr, statistics);
            for (const Photon& photon : std::get<Store<Photon>>(maps.volume).records) {
                const double way = double((photon.position - loaded.scene->camera.position()).length());
                const int frame = loaded.scene->transport.gate.frameOf(photon.time + way);
                if (frame >= 0) ++counts[size_t(frame)];
            }
        }
        return counts;
    };
    const auto uneven = countByFrame(10, 84000), even = countByFrame(1400, 600);
    for (size_t frame = 0; frame < 7; ++frame) {
        EXPECT_GT(even[frame], 400.0) << frame;
        // A path leaves a few photons: twice a Poisson error.
        EXPECT_NEAR(uneven[frame], even[frame], 9.0 * std::sqrt(even[frame] + uneven[frame])) << frame;
        EXPECT_LT(9.0 * std::sqrt(even[frame] + uneven[frame]), 0.28 * even[frame])
            << frame << ": the test would not see frames aimed at more often";
    }
}

/// Several camera samples of one pass: surfaces are connected and photons splatted on each sample's rays.
TEST_P(GuidedMaps, AgreeWithPathsAtSeveralSamplesAPass) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 9, "transient_time_width": 2)");
    const uint32_t passes = GetParam().darts == GuidedAlone ? 16 : 40;
    const auto photons = guided(json, {{setting("photon_count", 12000)}, passes, 3});
    if (GetParam().darts == GuidedAlone) {
        EXPECT_GT(photons->statistics.counter("surface connections"), 10000u);
    }
    expectSameBlocks(*photons, *renderPaths(json, {{}, 20, 64}), 0, 0.05, 0.25);
    const char* counter = GetParam().beams ? "gathered beams" : "gathered photons";
    const auto single = guided(json, {{setting("photon_count", 12000)}, passes, 1});
    const double expected = 3.0 * double(single->statistics.counter(counter));
    EXPECT_NEAR(double(photons->statistics.counter(counter)), expected, 0.05 * expected);
}

/// The image is one pixel; a black card before the lens hides half of it. With one camera path a pass half of the
/// passes would be black: a relative variance of 1 or more; with six it is 0.17 and what the light paths bring.
TEST(CameraPaths, SeeBothSidesOfAnEdgeInOnePass) {
    const std::string json = R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.5}],
        "primitives": [
            {"type": "cube", "bsdf": {"type": "lambert", "albedo": 0}, "int_medium": "fog", "ext_medium": "fog",
             "transform": {"position": [0.5, 0, -0.06], "scale": [1, 1, 0.02]}},
            {"type": "point", "emission": 8, "ext_medium": "fog", "transform": {"position": [0.8, 0.5, -3]}}],
        "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 20, "medium": "fog",
                   "transform": {"position": [0, 0, 0], "look_at": [0, 0, -1], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "max_bounces": 12, "transient_time_center": 6,
                       "transient_time_width": 2}})";
    constexpr uint32_t Passes = 32;
    const test::RenderOptions options{
        {GuidedAlone, setting("photon_count", 3000), setting("volume_gather_radius", 0.03)}, Passes, 1};
    const double paths = renderPaths(json, {{}, 64, 4096})->mean();
    for (const auto& rendered : {renderBeams(json, options), renderPhotons(json, options)}) {
        const double mean = rendered->mean(), error = rendered->pixelError();
        const double variance = Passes * error * error / (mean * mean);
        EXPECT_NEAR(mean, paths, 4.5 * error + 0.01 * paths);
        EXPECT_LT(variance, 0.5);
        EXPECT_GT(variance, 0.1) << "the card should hide some of them";
    }
}

/// Rounding moves photons across the ends of short frames, where paths that aim at one of them lose no light.
TEST(GuidedFrames, MayBeShort) {
    const std::string json = test::fogOverFloor(R"("start_time": 7, "transient_time_width": 1e-5, "frame_num": 8)");
    const auto mean = [&](const char* single) {
        const Overrides overrides{std::string(R"(integrator.darts={"preset": "published", "single_frames": )") +
                                      single + "}",
                                  "integrator.include_surfaces=false", "integrator.photon_count=20000"};
        double sum = 0.0;
        const auto rendered = renderPhotons(json, {overrides, 32, 1});
        for (int frame = 0; frame < 8; ++frame) sum += rendered->mean(frame) / 8.0;
        return sum;
    };
    const double whole = mean("false");
    EXPECT_GT(whole, 0.0);
    EXPECT_NEAR(mean("true"), whole, 0.005 * whole);
}

/// Where radii follow the density the largest fixed radius does not matter, not at the image's border either: photons
/// beyond it show in the image, and are what the density there is.
TEST(GuidedPoints, AreNotCulledByARadiusThatIsNotTheirs) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 7, "transient_time_width": 1)");
    const auto mean = [&](const std::string& radius) {
        return renderPhotons(
                   json, {{GuidedAlone, "integrator.fixed_volume_radius=false", "integrator.include_surfaces=false",
                           "camera.fov=3", "integrator.volume_gather_radius=" + radius, setting("photon_count", 4000)},
                          4,
                          1})
            ->mean();
    };
    const double all = mean("1000");
    EXPECT_GT(all, 0.0);
    EXPECT_NEAR(mean("0.0005"), all, 1e-5 * all);
}

TEST_P(GuidedMaps, FullStoresStayUnbiased) {
    const std::string json = test::configurationA(2, false);
    // A wide view keeps more: the ray is the same.
    const std::string wide = "camera.fov=60";
    const auto big = guided(json, {{wide, setting("photon_count", 15000)}, 30, 1});
    const auto small = guided(json, {{wide, "integrator.volume_photon_count=1000"}, 120, 1});
    const char* counter = GetParam().beams ? "photon beams" : "stored volume photons";
    EXPECT_LE(small->statistics.counter(counter), 120u * 1000u);
    EXPECT_GT(small->statistics.counter(counter), 120u * 900u);
    EXPECT_NEAR(small->mean(), big->mean(), 4.0 * std::hypot(small->pixelError(), big->pixelError()));
    EXPECT_LT(small->pixelError(), 0.2 * small->mean());
}

TEST_P(GuidedMaps, SameImageOnOneAndTwoThreadsWithinAMillionth) {
    const std::string json = test::fogOverFloor(R"("start_time": 6, "transient_time_width": 1, "frame_num": 4)");
    for (const uint32_t samples : {1u, 2u}) {
        const auto one = guided(json, {{setting("photon_count", 10000)}, 2, samples, 7, 1}),
                   two = guided(json, {{setting("photon_count", 10000)}, 2, samples, 7, 2});
        for (int frame = 0; frame < 4; ++frame) {
            const Image a = one->film.mean(frame), b = two->film.mean(frame);
            for (size_t i = 0; i < a.pixels.size(); ++i)
                EXPECT_NEAR(a.pixels[i].y, b.pixels[i].y, 1e-6f * a.pixels[i].y);
        }
        EXPECT_EQ(one->statistics.counter("rays"), two->statistics.counter("rays"));
        EXPECT_GT(one->mean(), 0.0);
    }
}

} // namespace
} // namespace tungsten::photon
