// The record of camera paths: straight segments, visible points, legs.

#include "photon/view/CameraRecord.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/Render.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

/// Two clouds and a mirror behind them, in which a wall behind the camera shows.
constexpr const char* Bench =
    R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.2, "sigma_s": [0.1, 0.2, 0.3]},
                                            {"name": "haze", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": 0.4},
                                            {"name": "ink", "type": "homogeneous", "sigma_a": 0.5}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": [9, 9, 2]}},
                    {"type": "cube", "int_medium": "ink", "bsdf": {"type": "forward"}, "transform": {"position": [0, 0, 1.75], "scale": [9, 9, 0.5]}},
                    {"type": "cube", "int_medium": "haze", "bsdf": {"type": "forward"}, "transform": {"position": [0, 0, 3], "scale": [9, 9, 1]}},
                    {"type": "cube", "bsdf": {"type": "mirror", "albedo": 0.9}, "transform": {"position": [0, 0, 6], "scale": [8, 8, 2]}},
                    {"type": "cube", "bsdf": {"type": "lambert", "albedo": 0.5}, "transform": {"position": [0, 0, -10], "scale": [20, 20, 2]}},
                    {"type": "point", "emission": 1, "transform": {"position": [0, 3, 0]}}],
     "camera": {"type": "pinhole", "fov": 6, "resolution": [4, 3], "reconstruction_filter": "box",
                "transform": {"position": [0, 0, -5], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "transient_time_center": 10, "transient_time_width": 1}})";

TEST(CameraRecord, HoldsStraightPiecesAndVisiblePoints) {
    const test::SceneFile file(Bench);
    const LoadedScene loaded = loadScene(file.path(), {});
    Statistics statistics;
    const CameraRecord record = recordCameraSubpaths(*loaded.scene, {true, false}, 1, 0, {.points = true}, statistics);
    ASSERT_EQ(record.x.size(), 12u);
    ASSERT_EQ(record.mediumSegments.size(), 2u)
        << "nothing scatters in the ink, and behind the mirror the ray is not straight";
    ASSERT_EQ(record.points.size(), 12u);
    const MediumSegment &fog = record.mediumSegments[0], &haze = record.mediumSegments[1];
    for (size_t i = 0; i < 12; ++i) {
        const float slant = 1.0f / record.z[i];
        EXPECT_NEAR(fog.start[i], 4.0f * slant, 1e-4f);
        EXPECT_NEAR(fog.end[i], 6.0f * slant, 1e-3f);
        EXPECT_EQ(fog.medium[i], 0);
        EXPECT_EQ(fog.interactions[i], 1);
        EXPECT_EQ(fog.throughput[i].x, 1.0f);
        EXPECT_NEAR(haze.start[i], 7.5f * slant, 1e-3f);
        EXPECT_NEAR(haze.end[i], 8.5f * slant, 1e-3f);
        EXPECT_EQ(haze.medium[i], 1);
        EXPECT_EQ(haze.interactions[i], 5) << "two boundaries each of fog and ink, one of the haze";
        EXPECT_NEAR(haze.throughput[i].z, std::exp(-(0.5f * 2.0f + 0.5f * 0.5f) * slant), 1e-3f);
        const VisiblePoint& point = record.points[i];
        EXPECT_EQ(point.pixel, i);
        EXPECT_NEAR(point.time, double(24.0f * slant), 2e-3) << "10 to the mirror, 14 back to the wall";
        EXPECT_NEAR(point.hit.position.z, -9.0f, 1e-3f);
        EXPECT_EQ(point.interactions, 13);
        EXPECT_LT(point.direction.z, 0.0f);
        EXPECT_NEAR(point.throughput.x, 0.9f * std::exp(-2.0f * (0.3f * 2.0f + 0.5f * 0.5f + 0.5f) * slant), 1e-3f);
    }
    const CameraRecord three = recordCameraSubpaths(*loaded.scene, {true, false}, 1, 0, {true, 3}, statistics);
    ASSERT_EQ(three.points.size(), 36u);
    EXPECT_EQ(three.x, record.x);
    EXPECT_EQ(three.mediumSegments[0].end, record.mediumSegments[0].end);
    for (size_t i = 0; i < 36; ++i) {
        EXPECT_EQ(three.points[i].pixel, i / 3);
        EXPECT_NEAR(three.points[i].throughput.x, record.points[i / 3].throughput.x / 3.0f, 1e-3f);
        EXPECT_EQ(three.points[i].hit.position == record.points[i / 3].hit.position, i % 3 == 0);
    }
    const CameraRecord volumeOnly = recordCameraSubpaths(*loaded.scene, {false, false}, 1, 0, {}, statistics);
    EXPECT_TRUE(volumeOnly.points.empty());
    EXPECT_EQ(volumeOnly.mediumSegments.size(), 2u);
    EXPECT_EQ(volumeOnly.x, record.x) << "the same rays";
    EXPECT_NE(recordCameraSubpaths(*loaded.scene, {false, false}, 1, 1, {}, statistics).x, record.x)
        << "another sample";
}

/// Slower in vacuum, slower still in clouds and ink.
TEST(CameraRecord, TimesGoByTheSpeedOfEachRegion) {
    const test::SceneFile file(Bench);
    const std::string slower = ".speed_of_light=0.25";
    const LoadedScene loaded = loadScene(file.path(), {{},
                                                       {"integrator.vacuum_speed_of_light=0.5", "media.fog" + slower,
                                                        "media.haze" + slower, "media.ink" + slower}});
    Statistics statistics;
    const CameraRecord record = recordCameraSubpaths(*loaded.scene, {true, false}, 1, 0, {.points = true}, statistics);
    ASSERT_EQ(record.points.size(), 12u);
    for (size_t i = 0; i < 12; ++i)
        EXPECT_NEAR(record.points[i].time, double((17.0f / 0.5f + 7.0f / 0.25f) / record.z[i]), 5e-3)
            << "twice through fog of 2, ink of 0.5 and haze of 1; 24 in all";
}

/// What a visitor is shown, in words.
struct Listing {
    std::vector<std::string> seen;
    void segment(const CameraSubpath& state, const std::optional<SurfaceHit>& hit) {
        seen.push_back("segment " + std::to_string(state.interactions) + (state.redirected ? " redirected " : " ") +
                       std::to_string(hit ? hit->t : 0.0f) + " " + std::to_string(state.throughput.x));
    }
    void surface(const CameraSubpath& state, const SurfaceInteraction& surface) {
        seen.push_back("surface " + std::to_string(surface.hit.position.z) + " " + std::to_string(state.throughput.x));
    }
    void escaped(const CameraSubpath&) { seen.emplace_back("escaped"); }
};

TEST(CameraRecord, ReplaysWhatTheCameraPathsMet) {
    const test::SceneFile file(Bench);
    const LoadedScene loaded = loadScene(file.path(), {});
    const Scene& scene = *loaded.scene;
    Statistics statistics;
    const CameraRecord record = recordCameraSubpaths(scene, {true, false}, 1, 0, {.segments = true}, statistics);
    for (size_t pixel = 0; pixel < 12; ++pixel) {
        Sampler sampler(1, RandomStream::Camera, 0, pixel);
        const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
        const Ray ray = scene.camera.generateRay({int(pixel % 4), int(pixel / 4)}, uFilter, uLens);
        Listing traced, replayed;
        followCameraSubpath(scene, ray, {true, false}, sampler, traced);
        record.replay(scene, pixel, replayed);
        EXPECT_EQ(traced.seen, replayed.seen);
        EXPECT_GT(traced.seen.size(), 20u) << "through fog, ink and haze to the mirror and back";
    }
}

/// States at the surfaces of a path.
struct States {
    std::vector<CameraSubpath> seen;
    bool escapedAtLast = false;
    void segment(const CameraSubpath& state, const std::optional<SurfaceHit>& hit) {
        EXPECT_EQ(state.ray.origin.z < 0.0f ? -1 : state.region.medium, state.region.medium);
        EXPECT_TRUE(hit || state.redirected);
    }
    void surface(const CameraSubpath& state, const SurfaceInteraction&) { seen.push_back(state); }
    void escaped(const CameraSubpath&) { escapedAtLast = true; }
};

/// A metal that is nearly a mirror, behind a sheet that light passes straight; behind the camera a real one.
TEST(CameraSubpath, KnowsItsLastGlossyVertexUntilAMirror) {
    const test::SceneFile file(R"({
      "primitives": [{"type": "cube", "bsdf": {"type": "rough_conductor", "material": "Al", "roughness": 0.01},
                      "transform": {"position": [0, 0, 5], "scale": [40, 40, 2]}},
                     {"type": "quad", "bsdf": {"type": "forward"}, "transform": {"position": [0, 0, 1], "rotation": [90, 0, 0], "scale": 40}},
                     {"type": "cube", "bsdf": {"type": "mirror", "albedo": 0.5},
                      "transform": {"position": [0, 0, -9], "scale": [40, 40, 2]}}],
      "camera": {"type": "pinhole", "fov": 1, "resolution": 1,
                 "transform": {"position": [0, 0, 0], "look_at": [0, 0, 1], "up": [0, 1, 0]}},
      "integrator": {"type": "progressive_photon_map", "max_bounces": 6}})");
    const LoadedScene loaded = loadScene(file.path(), {});
    const Ray ray{Vec3f(0.0f), Vec3f(0.0f, 0.0f, 1.0f)};
    States path;
    const CameraSubpathCounters steps =
        followCameraSubpath(*loaded.scene, ray, {true, true}, {1, RandomStream::Test, 0, 0}, path);
    ASSERT_EQ(path.seen.size(), 6u) << "sheet, metal, sheet, mirror, sheet, metal: as many as count";
    const auto expectState = [&](size_t i, bool redirected, bool glossy, bool density) {
        EXPECT_EQ(path.seen[i].redirected, redirected) << i;
        EXPECT_EQ(path.seen[i].glossy, glossy) << i;
        EXPECT_EQ(path.seen[i].glossyPdf > 0.0f, density) << i;
        EXPECT_EQ(path.seen[i].interactions, int(i));
    };
    expectState(0, false, false, false);
    expectState(1, false, false, false);
    expectState(2, true, true, true);
    expectState(3, true, true, true);
    expectState(4, true, true, false);
    expectState(5, true, true, false);
    EXPECT_EQ(path.seen[2].glossyPdf, path.seen[3].glossyPdf);
    EXPECT_NEAR(path.seen[3].glossyVertex.z, 4.0f, 1e-5f);
    EXPECT_EQ(path.seen[1].throughput.x, 1.0f);
    EXPECT_NEAR(path.seen[4].throughput.x, 0.5f * path.seen[3].throughput.x, 1e-6f);
    EXPECT_EQ(steps.glossy, 2u);
    EXPECT_EQ(steps.mirrored, 1u);
    EXPECT_EQ(steps.straight, 3u);
    // Without glossy ones the metal ends the path.
    States short_;
    followCameraSubpath(*loaded.scene, ray, {true, false}, {1, RandomStream::Test, 0, 0}, short_);
    EXPECT_EQ(short_.seen.size(), 2u);
}

} // namespace
} // namespace tungsten::photon
