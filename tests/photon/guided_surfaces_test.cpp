// Guided light paths on surfaces in whole scenes: connections, mirrors, glossy camera subpaths.

#include "support/Folders.h"
#include "support/PathsAndPhotons.h"
#include "support/SeedShift.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using test::expectSameBlocks;
using test::GuidedAlone;
using test::Overrides;
using test::Rendered;
using test::renderPaths;
using test::renderPhotons;
using test::setting;

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
    const auto connected = renderPhotons(json, {with(GuidedAlone), 32, 1});
    EXPECT_GT(connected->statistics.counter("surface connections"), 10000u);
    for (int frame = 0; frame < 2; ++frame) {
        SCOPED_TRACE(frame);
        expectSameBlocks(*connected, *paths, frame, 0.03, 0.1);
    }
    const auto photons = renderPhotons(json, {with(R"(integrator.darts={"surface_connections": false})"), 24, 1});
    EXPECT_EQ(photons->statistics.counter("surface connections"), 0u);
    for (int frame = 0; frame < 2; ++frame) {
        SCOPED_TRACE(frame);
        expectSameBlocks(*connected, *photons, frame, 0.05, 0.3);
    }
}

/// A block and a wall of rough metal, which show lamp, floor and each other.
TEST(GlossySurfaces, AreRightWithAndWithoutGlossyCameraSubpaths) {
    const std::string json = room(R"("transient_time_center": 8.1, "transient_time_width": 1.2)");
    const Overrides metal{R"(primitives.block.bsdf={"type": "rough_conductor", "material": "Ag", "roughness": 0.3})",
                          R"(primitives.wall.bsdf={"type": "rough_conductor", "material": "Au", "roughness": 0.4})",
                          "integrator.min_bounces=0"};
    const auto with = [&](const std::string& darts) {
        Overrides all = metal;
        all.push_back(darts);
        return all;
    };
    const auto paths = renderPaths(json, {metal, 16, 160});
    const auto followed = renderPhotons(json, {with(GuidedAlone), 40, 1});
    expectSameBlocks(*followed, *paths, 0, 0.03, 0.1);
    const auto photons = renderPhotons(json, {with(R"(integrator.darts={"glossy_sensor_paths": false})"), 30, 1});
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
                   json, {{GuidedAlone, "media.fog.speed_of_light=" + std::to_string(speed),
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
    const auto paths = renderPaths(json, {metal, 16, 160});
    metal.push_back(GuidedAlone);
    expectSameBlocks(*renderPhotons(json, {metal, 36, 1}), *paths, 0, 0.05, 0.15);
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

/// A lamp so large that paths which leave smooth metal often meet it, in a mirror beside: photons bring that light
/// already.
TEST(GlossySurfaces, CountLampsInMirrorsOnce) {
    const test::OtherSeeds seeds(2);
    const std::string json =
        R"({"media": [{"name": "air", "type": "homogeneous", "sigma_a": 0.05, "sigma_s": 1e-5}],
         "primitives": [{"type": "cube", "bsdf": {"type": "rough_conductor", "material": "Ag", "roughness": 0.15}, "ext_medium": "air",
                         "transform": {"position": [0, 0, -0.5], "scale": [2, 2, 1]}},
                        {"type": "cube", "bsdf": {"type": "mirror", "albedo": 0.9}, "ext_medium": "air",
                         "transform": {"position": [2.5, 0, 4], "scale": [1, 4, 5]}},
                        {"type": "sphere", "bsdf": {"type": "null"}, "ext_medium": "air", "emission": 10,
                         "transform": {"position": [0.5, 0, 8], "scale": 4}}],
         "camera": {"type": "pinhole", "resolution": [16, 16], "fov": 28, "medium": "air", "reconstruction_filter": "box",
                    "transform": {"position": [-1.5, 0, 3], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
         "integrator": {"type": "progressive_transient_photon_map", "photon_count": 10000, "volume_gather_radius": 0.05,
                        "gather_radius": 0.1, "gather_photon_count": 100000, "min_bounces": 2, "max_bounces": 3,
                        "transient_time_center": 11, "transient_time_width": 8}})";
    const auto [expected, pathError] = meanOverSeeds([&](uint64_t seed) {
        return renderPaths(json, {{"integrator.darts=off"}, 4, 64, seed});
    });
    const auto [mean, error] = meanOverSeeds([&](uint64_t seed) {
        return renderPhotons(json,
                             {{R"(integrator.darts={"plain_share": 0, "surface_connections": false})"}, 4, 1, seed});
    });
    EXPECT_NEAR(mean, expected, 4.5 * std::hypot(error, pathError) + 0.02 * expected);
    EXPECT_LT(std::hypot(error, pathError), 0.1 * expected) << "the test would not see a wrong value";
}

/// A wall of smooth metal in which four lamps show. Connections choose one of the four; reflected paths meet any.
TEST(GlossySurfaces, ShowSeveralLamps) {
    const auto lamp = [](const char* position) {
        return std::string(R"({"type": "sphere", "bsdf": {"type": "null"}, "ext_medium": "air", "emission": 30,
                               "transform": {"position": )") +
               position + R"(, "scale": 0.5}},)";
    };
    const std::string json =
        R"({"media": [{"name": "air", "type": "homogeneous", "sigma_a": 0.08, "sigma_s": 1e-5}], "primitives": [)" +
        lamp("[1, 0.8, 1]") + lamp("[-1, 0.8, 1]") + lamp("[1, -0.8, 1]") + lamp("[-1, -0.8, 1]") +
        R"({"type": "quad", "bsdf": {"type": "rough_conductor", "material": "Ag", "roughness": 0.3}, "ext_medium": "air",
            "transform": {"rotation": [90, 0, 0], "scale": 6}}],
         "camera": {"type": "pinhole", "resolution": [16, 16], "fov": 25, "medium": "air", "reconstruction_filter": "box",
                    "transform": {"position": [0, 0, 4], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
         "integrator": {"type": "progressive_transient_photon_map", "photon_count": 100, "volume_gather_radius": 0.05,
                        "min_bounces": 1, "max_bounces": 2, "transient_time_center": 6, "transient_time_width": 4}})";
    const auto [expected, pathError] = meanOverSeeds([&](uint64_t seed) {
        return renderPaths(json, {{"integrator.darts=off"}, 4, 64, seed});
    });
    const auto [mean, error] = meanOverSeeds([&](uint64_t seed) {
        return renderPhotons(json, {{GuidedAlone}, 8, 1, seed});
    });
    EXPECT_NEAR(mean, expected, 4.5 * std::hypot(error, pathError));
    EXPECT_LT(std::hypot(error, pathError), 0.01 * expected) << "the test would not see a wrong value";
}

/// Fog on rough metal, of which every highlight path gathers a part: without it a third of the light would be missing.
TEST(GlossySurfaces, ShowFog) {
    const test::OtherSeeds seeds(5);
    const std::string json = room(R"("transient_time_center": 8.1, "transient_time_width": 1.2)");
    const Overrides foggy{R"(primitives.wall.bsdf={"type": "rough_conductor", "material": "Ag", "roughness": 0.2})",
                          R"(primitives.block.bsdf={"type": "lambert", "albedo": 0})",
                          R"(primitives.floor.bsdf={"type": "lambert", "albedo": 0})",
                          "camera.resolution=[16, 16]",
                          "media.air.sigma_s=0.02",
                          "integrator.min_bounces=2",
                          "integrator.max_bounces=3",
                          "integrator.volume_gather_radius=0.1"};
    Overrides best = foggy;
    best.push_back(GuidedAlone);
    Overrides alone = foggy; // of plain paths the variance is infinite
    alone.push_back(R"(integrator.darts={"plain_share": 0})");
    const auto [expected, pathError] = meanOverSeeds([&](uint64_t seed) {
        return renderPaths(json, {alone, 8, 64, seed});
    });
    for (const char* primitive : {"points", "beams"}) {
        SCOPED_TRACE(primitive);
        Overrides maps = best;
        maps.push_back(std::string("integrator.volume_photon_type=") + primitive);
        const auto [mean, error] = meanOverSeeds([&](uint64_t seed) {
            return renderPhotons(json, {maps, 24, 1, seed});
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
        guided.push_back(GuidedAlone);
        const std::string json = room(RoomGate);
        expectSameBlocks(*renderPhotons(json, {guided, 24, 1}), *renderPaths(json, {limits, 8, 128}), 1, 0.05, 0.3);
    }
}

/// Photons are left where a mirror sends light that connections cannot bring, and as densely as the light itself.
TEST(SurfaceConnections, LeavePhotonsToMirrorsAlone) {
    const std::string json = room(RoomGate);
    const auto stored = [&](Overrides overrides) {
        overrides.push_back(GuidedAlone);
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
        Overrides all{Mirror, GuidedAlone, setting("photon_count", 20000)};
        all.insert(all.end(), settings.begin(), settings.end());
        return meanOverSeeds([&](uint64_t seed) { return renderPhotons(json, {all, 2, 1, seed}); });
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
                                  GuidedAlone};
        return renderPhotons(json, {overrides, 4, 1})->mean();
    };
    EXPECT_GT(mean("2"), 0.0);
    EXPECT_EQ(mean("1"), 0.0);
}

/// One pixel within the mirror; the warm light of the fog that it shows.
TEST(DirectView, IsWrongInAMirrorAndTheDefaultIsRight) {
    const test::OtherSeeds seeds(2);
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
        return Warm(*test::renderPhotonFile(file, {all, 20, 16}));
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
