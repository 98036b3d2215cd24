// Guided light paths in whole scenes: surfaces, mirrors, sequences, several pulses, full stores, threads.

#include "photon/light/PhotonPass.h"
#include "tungsten/render/EffectPlan.h"
#include "tungsten/scene/Scene.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/Folders.h"
#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using test::Overrides;
using test::renderBeams;
using test::Rendered;
using test::renderPaths;
using test::renderPhotons;
using test::setting;

const std::string Published = "integrator.darts=published", Best = "integrator.darts=best";

/// Block means of two renders, 8 x 8 pixels, each within its combined error and `bias`, relative to the image's mean.
/// Pixels of a pass share photons: their errors add up at worst.
void expectSameBlocks(const Rendered& a, const Rendered& b, int frame, double bias, double largestError) {
    const Image va = a.film.mean(frame), vb = b.film.mean(frame);
    const Image ea = a.film.standardError(frame), eb = b.film.standardError(frame);
    const double average = b.mean(frame);
    ASSERT_GT(average, 0.0);
    double errors = 0.0;
    const int columns = va.width / 8, blocks = columns * (va.height / 8);
    for (int block = 0; block < blocks; ++block) {
        double difference = 0.0, correlated = 0.0, independent = 0.0;
        for (int i = 0; i < 64; ++i) {
            const int x = 8 * (block % columns) + i % 8, y = 8 * (block / columns) + i / 8;
            difference += double(va.at(x, y).y - vb.at(x, y).y) / 64.0;
            correlated += double(ea.at(x, y).y) / 64.0;
            independent += double(eb.at(x, y).y * eb.at(x, y).y) / (64.0 * 64.0);
        }
        const double error = std::sqrt(correlated * correlated + independent);
        EXPECT_LT(std::abs(difference), 4.0 * error + bias * average) << "frame " << frame << " block " << block;
        errors += error / blocks;
    }
    EXPECT_LT(errors, largestError * average) << "frame " << frame << ": the test would not see a wrong value";
}

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
                         testing::Values(MapCase{"PublishedPoints", Published, false},
                                         MapCase{"BestPoints", Best, false}, MapCase{"PublishedBeams", Published, true},
                                         MapCase{"BestBeams", Best, true}),
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
    const auto photons = guided(json, {{setting("photon_count", GetParam().darts == Best ? 12000 : 24000)}, 40, 1});
    const auto paths = renderPaths(json, {{}, 20, 64});
    for (int frame = 0; frame < 3; ++frame) expectSameBlocks(*photons, *paths, frame, 0.05, 0.25);
    EXPECT_EQ(photons->statistics.counter("non-finite samples"), 0u);
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
    const auto photons = guided(json, {{setting("photon_count", 12000)}, 40, 3});
    if (GetParam().darts == Best) {
        EXPECT_GT(photons->statistics.counter("surface connections"), 10000u);
    }
    expectSameBlocks(*photons, *renderPaths(json, {{}, 20, 64}), 0, 0.05, 0.25);
    const char* counter = GetParam().beams ? "gathered beams" : "gathered photons";
    const auto single = guided(json, {{setting("photon_count", 12000)}, 40, 1});
    const double expected = 3.0 * double(single->statistics.counter(counter));
    EXPECT_NEAR(double(photons->statistics.counter(counter)), expected, 0.05 * expected);
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
                   json, {{Best, "integrator.fixed_volume_radius=false", "integrator.include_surfaces=false",
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

/// Surfaces alone: in fog too thin to show, a lamp lights a corner of two walls and a block, first hand and from wall
/// to wall, and one wall through a mirror.
std::string room(const std::string& gate) {
    return R"({"media": [{"name": "air", "type": "homogeneous", "sigma_a": 0.08, "sigma_s": 1e-5}],
     "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.7}],
     "primitives": [{"name": "floor", "type": "quad", "bsdf": "grey", "transform": {"scale": [6, 1, 6]}},
                    {"name": "wall", "type": "cube", "bsdf": "grey", "transform": {"position": [0, 1.5, -2.1], "scale": [6, 3, 0.2]}},
                    {"name": "block", "type": "cube", "bsdf": "grey", "transform": {"position": [-0.8, 0.4, -0.6], "scale": 0.8}},
                    {"name": "lamp", "type": "sphere", "bsdf": {"type": "null"}, "ext_medium": "air", "emission": 30,
                     "transform": {"position": [1.2, 1.8, -0.4], "scale": 0.2}}],
     "camera": {"type": "pinhole", "resolution": [24, 24], "fov": 40, "medium": "air", "reconstruction_filter": "box",
                "transform": {"position": [0, 1.4, 5], "look_at": [0, 0.8, -1], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "max_bounces": 6, "enable_rr": false, "photon_count": 4000,
                    "volume_photon_count": 200000, "gather_radius": 0.12, "gather_photon_count": 100000, "fixed_volume_radius": true,
                    "volume_gather_radius": 0.05, "alpha": 0.3, "volume_alpha": 1, "min_bounces": 1, )" +
           gate + "}}";
}
constexpr const char* RoomGate = R"("start_time": 7.5, "transient_time_width": 1.2, "frame_num": 2)";
/// The block becomes a mirror, which shows the lit floor; the view is indirect.
const std::string Mirror = R"(primitives.block.bsdf={"type": "mirror", "albedo": 0.9})";

class SurfaceLight : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WithoutAndWithAMirror, SurfaceLight, testing::Bool());

TEST_P(SurfaceLight, ByConnectionsIsThatOfPathsAndPhotons) {
    const Overrides change = GetParam() ? Overrides{Mirror} : Overrides{};
    const auto with = [&](const std::string& darts) {
        Overrides all = change;
        all.push_back(darts);
        return all;
    };
    const std::string json = room(RoomGate);
    const auto paths = renderPaths(json, {change, 16, 128});
    const auto connected = renderPhotons(json, {with(Best), 40, 1});
    EXPECT_GT(connected->statistics.counter("surface connections"), 10000u);
    for (int frame = 0; frame < 2; ++frame) {
        SCOPED_TRACE(frame);
        expectSameBlocks(*connected, *paths, frame, 0.03, 0.1);
    }
    const auto photons = renderPhotons(json, {with(R"(integrator.darts={"surface_connections": false})"), 40, 1});
    EXPECT_EQ(photons->statistics.counter("surface connections"), 0u);
    for (int frame = 0; frame < 2; ++frame) {
        SCOPED_TRACE(frame);
        expectSameBlocks(*connected, *photons, frame, 0.05, 0.3);
    }
}

/// A block and a wall of rough metal, which show lamp, floor and each other.
TEST(GlossySurfaces, AreRightWithAndWithoutGlossySensorPaths) {
    const std::string json = room(R"("transient_time_center": 8.1, "transient_time_width": 1.2)");
    const Overrides metal{R"(primitives.block.bsdf={"type": "rough_conductor", "material": "Ag", "roughness": 0.3})",
                          R"(primitives.wall.bsdf={"type": "rough_conductor", "material": "Au", "roughness": 0.4})",
                          "integrator.min_bounces=0"};
    const auto with = [&](const std::string& darts) {
        Overrides all = metal;
        all.push_back(darts);
        return all;
    };
    const auto paths = renderPaths(json, {metal, 16, 256});
    const auto followed = renderPhotons(json, {with(Best), 128, 1});
    expectSameBlocks(*followed, *paths, 0, 0.03, 0.1);
    const auto photons = renderPhotons(json, {with(R"(integrator.darts={"glossy_sensor_paths": false})"), 128, 1});
    expectSameBlocks(*photons, *paths, 0, 0.05, 0.3);
}

/// Fog at half the speed and a gate of twice the times are the same scene; the speed of a vacuum that no path can reach
/// does not matter. Straight from a lamp to rough metal.
TEST(GlossySurfaces, KnowTheSpeedThatMatters) {
    const auto mean = [](double speed) {
        const std::string json = R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.02}],
         "primitives": [{"type": "quad", "bsdf": {"type": "rough_conductor", "material": "Al", "roughness": 0.3}, "transform": {"scale": [6, 1, 6]}},
                        {"type": "point", "emission": 20, "ext_medium": "fog", "transform": {"position": [0, 2, 1]}}],
         "camera": {"type": "pinhole", "resolution": [16, 16], "fov": 45, "medium": "fog", "reconstruction_filter": "box",
                    "transform": {"position": [0, 1.5, 3], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
         "integrator": {"type": "progressive_transient_photon_map", "photon_count": 100, "max_bounces": 2, "volume_gather_radius": 0.05}})";
        return renderPhotons(
                   json, {{Best, "media.fog.speed_of_light=" + std::to_string(speed),
                           setting("transient_time_center", 5.6 / speed), setting("transient_time_width", 1.0 / speed)},
                          8,
                          1})
                   ->mean() /
               speed;
    };
    const double expected = mean(1.0);
    EXPECT_GT(expected, 0.0);
    EXPECT_NEAR(mean(0.5), expected, 0.02 * expected);
}

/// Light by way of a mirror on rough metal: the part that photons bring.
TEST(GlossySurfaces, ShowLightThatComesFromAMirror) {
    const std::string json = room(R"("transient_time_center": 8.1, "transient_time_width": 1.2)");
    Overrides metal{R"(primitives.floor.bsdf={"type": "mirror", "albedo": 0.9})",
                    R"(primitives.wall.bsdf={"type": "rough_conductor", "material": "Au", "roughness": 0.4})"};
    const auto paths = renderPaths(json, {metal, 16, 512});
    metal.push_back(Best);
    expectSameBlocks(*renderPhotons(json, {metal, 96, 1}), *paths, 0, 0.05, 0.15);
}

/// Mean over the image and its standard error, from the spread over seeds.
template <typename Render>
std::pair<double, double> meanOverSeeds(const Render& render) {
    constexpr int Seeds = 8;
    double sum = 0.0, squares = 0.0;
    for (uint64_t seed = 1; seed <= Seeds; ++seed) {
        const double mean = render(seed)->mean(0);
        sum += mean / Seeds;
        squares += mean * mean / Seeds;
    }
    return {sum, std::sqrt((squares - sum * sum) / (Seeds - 1))};
}

/// Fog on rough metal, of which every highlight path gathers a part: without it a third of the light would be missing.
TEST(GlossySurfaces, ShowFog) {
    const std::string json = room(R"("transient_time_center": 8.1, "transient_time_width": 1.2)");
    const Overrides foggy{R"(primitives.wall.bsdf={"type": "rough_conductor", "material": "Ag", "roughness": 0.2})",
                          R"(primitives.block.bsdf={"type": "lambert", "albedo": 0})",
                          R"(primitives.floor.bsdf={"type": "lambert", "albedo": 0})",
                          "media.air.sigma_s=0.02",
                          "integrator.min_bounces=2",
                          "integrator.max_bounces=3",
                          "integrator.volume_gather_radius=0.1"};
    Overrides best = foggy;
    best.push_back(Best); // of plain paths the variance is infinite
    const auto [expected, pathError] = meanOverSeeds([&](uint64_t seed) {
        return renderPaths(json, {best, 4, 64, seed});
    });
    for (const char* primitive : {"points", "beams"}) {
        SCOPED_TRACE(primitive);
        Overrides maps = best;
        maps.push_back(std::string("integrator.volume_photon_type=") + primitive);
        const auto [mean, error] = meanOverSeeds([&](uint64_t seed) {
            return renderPhotons(json, {maps, 10, 1, seed});
        });
        EXPECT_NEAR(mean, expected, 5.0 * std::hypot(error, pathError) + 0.02 * expected);
        EXPECT_LT(std::hypot(error, pathError), 0.05 * expected) << "the test would not see a wrong value";
    }
}

/// Orders one by one: every path is counted with its own number of interactions, connected or not.
TEST(SurfaceConnections, CountInteractionsAsPathsDo) {
    for (const int order : {1, 2}) {
        SCOPED_TRACE(order);
        const Overrides limits{setting("min_bounces", order), setting("max_bounces", order + 1),
                               setting("photon_count", 4000)};
        Overrides guided = limits;
        guided.push_back(Best);
        const std::string json = room(RoomGate);
        expectSameBlocks(*renderPhotons(json, {guided, 24, 1}), *renderPaths(json, {limits, 8, 128}), 1, 0.05, 0.3);
    }
}

/// Photons are left where a mirror sends light that connections cannot bring, and as densely as the light itself.
TEST(SurfaceConnections, LeavePhotonsToMirrorsAlone) {
    const std::string json = room(RoomGate);
    const auto stored = [&](Overrides overrides) {
        overrides.push_back(Best);
        const auto render = renderPhotons(json, {overrides, 2, 1});
        EXPECT_GT(render->statistics.counter("surface connections"), 1000u);
        return render->statistics.counter("stored surface photons");
    };
    EXPECT_EQ(stored({}), 0u);
    EXPECT_GT(stored({Mirror}), 1000u);
}

/// What a mirror sends is gathered from the nearest photons as from all within a radius, also where none bounds them.
TEST(SurfaceConnections, GatherTheNearestPhotonsBesideAMirror) {
    const std::string json = room(R"("transient_time_center": 8.1, "transient_time_width": 1.2)");
    const auto gathered = [&](const Overrides& settings) {
        Overrides all{Mirror, Best, setting("photon_count", 20000)};
        all.insert(all.end(), settings.begin(), settings.end());
        return meanOverSeeds([&](uint64_t seed) { return renderPhotons(json, {all, 7, 1, seed}); });
    };
    const auto [expected, radiusError] = gathered({});
    const auto [mean, error] = gathered({"integrator.gather_radius=1e30", "integrator.gather_photon_count=20"});
    EXPECT_NEAR(mean, expected, 4.0 * std::hypot(error, radiusError) + 0.03 * expected);
    EXPECT_LT(std::hypot(error, radiusError), 0.02 * expected) << "the test would not see a wrong value";
}

/// A floor lit through scattering fog, seen beside it: with one flight allowed in the fog none of that light gets out,
/// neither by flying on nor by a connection.
TEST(SurfaceConnections, KeepTheMediumsLimit) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 9, "transient_time_width": 6)");
    const auto mean = [&](const std::string& flights) {
        const Overrides overrides{"camera.transform.look_at=[2.4, 0, 2.4]",
                                  "camera.fov=15",
                                  "media.fog.sigma_s=2",
                                  "integrator.min_bounces=4",
                                  "integrator.max_bounces=5",
                                  setting("photon_count", 4000),
                                  "media.fog.max_bounces=" + flights,
                                  Best};
        return renderPhotons(json, {overrides, 4, 1})->mean();
    };
    EXPECT_GT(mean("2"), 0.0);
    EXPECT_EQ(mean("1"), 0.0);
}

/// One pixel within the mirror; the warm light of the fog that it shows.
TEST(DirectView, IsWrongInAMirrorAndTheDefaultIsRight) {
    struct Warm {
        double mean, error;
        explicit Warm(const Rendered& render)
            : mean(double(render.film.mean(0).at(0, 0).x)), error(double(render.film.standardError(0).at(0, 0).x)) {}
    };
    const std::filesystem::path file = test::dataFolder() / "scenes/mirror-fog/scene.json";
    const Overrides mirror{"camera.resolution=[1, 1]", "camera.fov=14", "integrator.volume_alpha=1",
                           "integrator.alpha=1", setting("photon_count", 8000)};
    const auto render = [&](const std::string& darts) {
        Overrides all = mirror;
        all.push_back(darts);
        return Warm(*test::renderPhotonFile(file, {all, 20, 128}));
    };
    const Warm paths(*test::renderPathFile(file, {mirror, 16, 4096}));
    for (const std::string preset : {"published", "best"}) {
        SCOPED_TRACE(preset);
        const Warm right = render("integrator.darts=" + preset);
        EXPECT_NEAR(right.mean, paths.mean, 4.0 * std::hypot(right.error, paths.error) + 0.03 * paths.mean);
        EXPECT_LT(std::hypot(right.error, paths.error), 0.1 * paths.mean);
        const Warm wrong = render(R"(integrator.darts={"direct_view": "on", "preset": ")" + preset + R"("})");
        EXPECT_LT(wrong.mean + 4.0 * wrong.error, 0.7 * paths.mean) << wrong.mean << " +- " << wrong.error;
        RecordProperty(preset + " right", std::to_string(right.mean / paths.mean));
        RecordProperty(preset + " wrong", std::to_string(wrong.mean / paths.mean));
    }
}

/// A thin wall between lamp and camera: light on its back must not be spread through to its front. The ceiling joins
/// the two rooms, so that something is connected at all.
TEST(SurfaceConnections, DoNotPassAThinWall) {
    const std::string scene = R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0, "sigma_s": 1e-4}],
        "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.7}],
        "primitives": [{"type": "quad", "bsdf": "grey", "transform": {"rotation": [0, 0, 90], "scale": 2}},
                       {"type": "quad", "bsdf": "grey", "transform": {"position": [-3, 0, 0], "rotation": [0, 0, -90], "scale": 6}},
                       {"type": "point", "emission": 9, "ext_medium": "fog", "transform": {"position": [-1, 0.1, 0.2]}}],
        "camera": {"fov": 30, "resolution": 8, "medium": "fog",
                   "transform": {"position": [2, 0, 0], "look_at": [0, 0, 0]}},
        "integrator": {"type": "progressive_transient_photon_map", "max_bounces": 3, "photon_count": 4000,
                       "volume_photon_count": 4000, "transient_time_center": 8, "transient_time_width": 8,
                       "darts": "best"}})";
    const auto rendered = renderPhotons(scene, {{}, 8});
    EXPECT_GT(rendered->statistics.counter("surface connections"), 0u);
    // What the fog in front of the wall scatters; through the wall it was 0.01 and more.
    EXPECT_LT(rendered->mean(), 1e-4);
}

} // namespace
} // namespace tungsten::photon
