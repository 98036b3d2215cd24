// Detectors against closed forms, and paths from them against paths to them.

#include "tungsten/scene/Scene.h"

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

std::string scene(const std::string& primitives, const std::string& detectors, const std::string& integrator = "") {
    return R"({"bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.6}], "primitives": [)" + primitives +
           R"(], "camera": {"type": "detectors", "detectors": [)" + detectors + R"(]},
        "integrator": {"max_bounces": 4)" +
           integrator + "}}";
}

/// Of one pixel: power is mean radiance times etendue.
double power(const test::Rendered& rendered, int column) {
    const auto& row = std::get<Detectors>(rendered.scene->camera.model).row;
    return double(rendered.film.mean(0).at(column, 0).y) * row[size_t(column)].etendue();
}
double powerError(const test::Rendered& rendered, int column) {
    const auto& row = std::get<Detectors>(rendered.scene->camera.model).row;
    return double(rendered.film.standardError(0).at(column, 0).y) * row[size_t(column)].etendue();
}

TEST(DetectorPower, OfAWallThatGlowsIsEtendueTimesRadiance) {
    // A panel of radiance 3 that fills what the fibre accepts.
    const std::string json =
        scene(R"({"type": "quad", "bsdf": {"type": "null"}, "emission": 3,
                                       "transform": {"position": [0, 0, 2], "rotation": [-90, 0, 0], "scale": 40}})",
              R"({"radius": 0.05, "numerical_aperture": 0.22}, {"radius": 0.2, "numerical_aperture": 0.5})");
    const auto paths = test::renderPaths(json, {{"integrator.type=path_tracer"}, 4, 16});
    const auto light = test::renderLight(json, {{"integrator.type=light_tracer"}, 40, 20000});
    for (int i = 0; i < 2; ++i) {
        const double radius = i == 0 ? 0.05 : 0.2, aperture = i == 0 ? 0.22 : 0.5;
        const double expected = 3.0 * M_PI * M_PI * radius * radius * aperture * aperture;
        EXPECT_NEAR(power(*paths, i), expected, 1e-5 * expected);
        EXPECT_NEAR(power(*light, i), expected, 4.5 * powerError(*light, i)) << i;
        EXPECT_LT(powerError(*light, i), 0.1 * expected) << "too noisy to see a wrong value";
    }
}

TEST(DetectorPower, OfASmallBucketIsItsIrradianceTimesItsArea) {
    // A ball of radiance 2 and radius 0.5 at distance 4 lights a bucket turned away by 60 degrees with pi L (r / d)^2
    // cos.
    const std::string ball = R"({"type": "sphere", "bsdf": {"type": "null"}, "emission": 2,
                                 "transform": {"position": [0, 0, 4], "scale": 0.5}})";
    const std::string json = scene(ball, R"({"radius": 0.01, "direction": [0, 0.8660254, 0.5]})");
    const double expected = M_PI * 2.0 * 0.25 / 16.0 * 0.5 * M_PI * 1e-4;
    const auto paths = test::renderPaths(json, {{"integrator.type=path_tracer"}, 40, 20000});
    const auto light = test::renderLight(json, {{"integrator.type=light_tracer"}, 40, 2000});
    EXPECT_NEAR(power(*paths, 0), expected, 4.5 * powerError(*paths, 0));
    EXPECT_LT(powerError(*paths, 0), 0.05 * expected);
    EXPECT_NEAR(power(*light, 0), expected, 4.5 * powerError(*light, 0));
    EXPECT_LT(powerError(*light, 0), 0.05 * expected);
}

TEST(DetectorPower, OfAFibreAtALambertWallByTimeOfFlight) {
    // A flash of intensity 4 at (0, 0, 1) lights a wall at z = 3, which a narrow fibre sees straight on from z = 0:
    // light goes 2 to the wall and 3 back, and its radiance is albedo / pi times I / 4.
    const std::string json = scene(
        R"({"type": "quad", "bsdf": "grey", "transform": {"position": [0, 0, 3], "rotation": [-90, 0, 0], "scale": 40}},
                                      {"type": "point", "emission": 4, "transform": {"position": [0, 0, 1]}})",
        R"({"radius": 0.001, "numerical_aperture": 0.001})",
        R"(, "min_bounces": 1, "max_bounces": 2, "start_time": 4.5, "transient_time_width": 0.25, "frame_num": 4)");
    const auto rendered = test::renderPaths(json, {{"integrator.type=path_tracer"}, 2, 16});
    const double expected = 0.6 / M_PI * 4.0 / 4.0 / 0.25;
    for (int frame = 0; frame < 4; ++frame)
        EXPECT_NEAR(rendered->mean(frame), frame == 2 ? expected : 0.0, 1e-3 * expected) << frame;
}

/// A room, in frames: by paths from the detectors and by light to them.
TEST(DetectorPower, OfARoomAgrees) {
    const std::string room =
        R"({"type": "quad", "bsdf": "grey", "transform": {"position": [0, -1, 0], "scale": [4, 1, 4]}},
        {"type": "quad", "bsdf": "grey", "transform": {"position": [0, 0, -2], "rotation": [90, 0, 0], "scale": [4, 1, 4]}},
        {"type": "sphere", "bsdf": {"type": "null"}, "emission": 6, "transform": {"position": [0.5, 0.6, 0], "scale": 0.3}})";
    const std::string detectors =
        R"({"position": [0, 0, 2], "direction": [0, -0.3, -1], "radius": 0.3, "numerical_aperture": 0.6},
        {"position": [-1, 0.5, 1], "direction": [0.2, -1, -0.5], "radius": 0.2, "numerical_aperture": 0.8})";
    const std::string json =
        scene(room, detectors, R"(, "start_time": 1, "transient_time_width": 1.5, "frame_num": 4)");
    const auto paths = test::renderPaths(json, {{"integrator.type=path_tracer"}, 30, 4000});
    const auto light = test::renderLight(json, {{"integrator.type=light_tracer"}, 30, 4000});
    for (int frame = 0; frame < 4; ++frame)
        for (int x = 0; x < 2; ++x) {
            const double expected = double(paths->film.mean(frame).at(x, 0).y);
            const double error = std::hypot(double(paths->film.standardError(frame).at(x, 0).y),
                                            double(light->film.standardError(frame).at(x, 0).y));
            EXPECT_NEAR(double(light->film.mean(frame).at(x, 0).y), expected, 4.5 * error + 1e-6) << frame << x;
            EXPECT_LT(error, 0.1 * expected + 2e-3) << frame << x;
        }
}

/// A spot of power 1 on a wall of albedo 0.6, and a bucket above it as wide as it is far, which gets half of what the
/// wall scatters (R^2 / (R^2 + h^2)): about as much by connections as by directions that meet it.
TEST(DetectorPower, OfASpotUnderAWideBucketIsHalfOfWhatItScatters) {
    const std::string json = scene(
        R"({"type": "quad", "bsdf": "grey", "transform": {"rotation": [90, 0, 0], "scale": 40}},
           {"type": "collimated", "radius": 0.01, "emission": 3183.0989,
            "transform": {"position": [0, 0, 2], "look_at": [0, 0, 0], "up": [0, 1, 0]}})",
        R"({"position": [0, 0, 1], "direction": [0, 0, -1], "radius": 1}, {"position": [9, 0, 1], "radius": 0.1})");
    const auto light = test::renderLight(json, {{"integrator.type=light_tracer"}, 40, 8000});
    EXPECT_NEAR(power(*light, 0), 0.3, 4.5 * powerError(*light, 0) + 1e-4);
    EXPECT_LT(powerError(*light, 0), 0.003);
}

/// What goes into a slab that absorbs nothing comes out on either side, however often paths are split on their way to a
/// fibre beside.
TEST(DetectorPower, OfBothSidesOfASlabIsWhatGoesIn) {
    const std::string json = R"({"media": [{"name": "milk", "type": "homogeneous", "sigma_s": 3, "sigma_a": 0,
                                            "phase_function": {"type": "henyey_greenstein", "g": 0.5}}],
        "primitives": [{"type": "cube", "int_medium": "milk", "bsdf": {"type": "forward"},
                        "transform": {"position": [0, 0, -0.5], "scale": [600, 600, 1]}},
                       {"type": "collimated", "radius": 0.01, "emission": 3183.0989,
                        "transform": {"position": [0, 0, 0.5], "look_at": [0, 0, 0], "up": [0, 1, 0]}}],
        "camera": {"type": "detectors", "detectors": [
            {"position": [0, 0, 0.01], "direction": [0, 0, -1], "radius": 200},
            {"position": [0, 0, -1.01], "direction": [0, 0, 1], "radius": 200},
            {"position": [2, 0, 0.02], "direction": [0, 0, -1], "radius": 0.2}]},
        "integrator": {"max_bounces": 10000}, "renderer": {}})";
    const auto light = test::renderLight(json, {{"integrator.type=light_tracer"}, 40, 3000});
    const double error = std::hypot(powerError(*light, 0), powerError(*light, 1));
    EXPECT_NEAR(power(*light, 0) + power(*light, 1), 1.0, 4.5 * error);
    EXPECT_LT(error, 0.01);
    EXPECT_GT(power(*light, 2), 5.0 * powerError(*light, 2)) << "nothing is split";
}

/// Light that leaves what scatters it forward, just under a bucket: by paths that meet the lamp, and by light paths
/// that are connected to the bucket or meet it.
TEST(DetectorPower, OfTissueUnderABucketAgrees) {
    for (const char* skin : {R"({"type": "forward"})", R"({"type": "dielectric", "ior": 1.4})"}) {
        const std::string json =
            R"({"media": [{"name": "tissue", "type": "homogeneous", "sigma_s": 12, "sigma_a": 0.1,
                           "phase_function": {"type": "henyey_greenstein", "g": 0.9}}],
            "primitives": [{"type": "cube", "int_medium": "tissue", "bsdf": )" +
            std::string(skin) + R"(, "transform": {"position": [0, 0, -0.5], "scale": [4, 4, 1]}},
              {"type": "sphere", "bsdf": {"type": "null"}, "emission": 6, "transform": {"position": [1, 0, 0.6], "scale": 0.4}}],
            "camera": {"type": "detectors", "detectors": [
              {"position": [0, 0, 0.02], "direction": [0, 0, -1], "radius": 0.2},
              {"position": [-0.6, 0, -1.02], "direction": [0, 0, 1], "radius": 0.3, "numerical_aperture": 0.5}]},
            "integrator": {"max_bounces": 1000}, "renderer": {}})";
        const auto paths = test::renderPaths(json, {{"integrator.type=path_tracer"}, 30, 4000});
        const auto light = test::renderLight(json, {{"integrator.type=light_tracer"}, 30, 12000});
        for (int x = 0; x < 2; ++x) {
            const double expected = double(paths->film.mean(0).at(x, 0).y);
            const double error = std::hypot(double(paths->film.standardError(0).at(x, 0).y),
                                            double(light->film.standardError(0).at(x, 0).y));
            EXPECT_NEAR(double(light->film.mean(0).at(x, 0).y), expected, 4.5 * error) << skin << x;
            EXPECT_LT(error, 0.08 * expected) << skin << x;
        }
    }
}

} // namespace
} // namespace tungsten::path
