// Times and values along specular camera paths: mirrors fold them, glass slows them.

#include "path/look_along.h"
#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

#include <map>

namespace tungsten::path {
namespace {

using test::renderPaths;

/// Frames of one render that hold light, with their values times the frame width.
std::map<int, double> litFrames(const test::Rendered& rendered, double width) {
    std::map<int, double> lit;
    for (int frame = 0; frame < rendered.film.frames(); ++frame)
        if (rendered.mean(frame) > 0.0) lit[frame] = rendered.mean(frame) * width;
    return lit;
}

/// The camera looks along +x into a mirror that turns the ray down onto the floor: 3, then 3, then 1 to the light.
std::string periscope(const std::string& integrator) {
    return R"({"primitives": [
        {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5}, "transform": {"scale": [20, 1, 20]}},
        {"type": "quad", "bsdf": {"type": "mirror", "albedo": 0.9},
         "transform": {"position": [0, 3, 0], "scale": 0.2, "rotation": [0, 0, -45]}},
        {"type": "point", "emission": 3, "emission_time": 0.05, "transform": {"position": [0.6, 0.8, 0]}}],)" +
           test::lookAlong("[-3, 3, 0]", "[0, 3, 0]", "[0, 1, 0]") +
           R"(, "integrator": {"type": "path_tracer", "min_bounces": 2, "max_bounces": 3, "transient_time_width": 0.1, )" +
           integrator + "}}";
}
constexpr double PeriscopeValue = 0.9 * 0.5 / M_PI * 3.0 * 0.8;

TEST(SpecularTime, MirrorPathsCountEverySegment) {
    const auto lit = litFrames(*renderPaths(periscope(R"("start_time": 0, "frame_num": 80)"), {{}, 1, 4}), 0.1);
    ASSERT_EQ(lit.size(), 1u);
    EXPECT_EQ(lit.begin()->first, 70); // 0.05 + 3 + 3 + 1
    EXPECT_NEAR(lit.begin()->second, PeriscopeValue, 1e-3 * PeriscopeValue);
}

TEST(SpecularTime, MirrorsBelongToTheCameraWhenUnwarped) {
    // Only 0.05 + 1 counts. In the narrow gate the light could not even reach the mirror in time; it need not.
    for (const std::string gate : {R"("start_time": 0, "frame_num": 80)", R"("start_time": 1, "frame_num": 1)"}) {
        const auto rendered = renderPaths(periscope(R"("camera_unwarped": true, )" + gate), {{}, 1, 4});
        const auto lit = litFrames(*rendered, 0.1);
        ASSERT_EQ(lit.size(), 1u) << gate;
        EXPECT_EQ(lit.begin()->first, rendered->film.frames() > 1 ? 10 : 0);
        EXPECT_NEAR(lit.begin()->second, PeriscopeValue, 1e-3 * PeriscopeValue);
    }
}

/// Straight down through the middle of a glass ball (radius 0.1, light at 2/3 inside) onto a floor lit from the side.
TEST(SpecularTime, GlassBallDelaysAndEchoes) {
    const std::string scene = R"({"primitives": [
        {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5}, "transform": {"scale": [20, 1, 20]}},
        {"type": "sphere", "bsdf": {"type": "dielectric", "ior": 1.5}, "int_speed_of_light": 0.6666667,
         "transform": {"position": [0.75, 1, 0], "scale": 0.1}},
        {"type": "point", "emission": 3, "transform": {"position": [0, 1, 0]}}],)" +
                              test::lookAlong("[0.75, 2, 0]", "[0.75, 0, 0]", "[1, 0, 0]") +
                              R"(, "integrator": {"type": "path_tracer", "max_bounces": 6, "start_time": 0,
                                   "transient_time_width": 0.02, "frame_num": 400}})";
    const auto rendered = renderPaths(scene, {{}, 100, 1000});
    const double floor = 0.5 / M_PI * 3.0 * 0.8 / (1.25 * 1.25);
    // 1.8 in air, 0.2 at speed 2/3, 1.25 to the light: 3.35. Two reflections inside add 0.6. Each end transmits 0.96.
    const int direct = int(3.35 / 0.02), echo = int(3.95 / 0.02);
    double directSum = 0.0, echoSum = 0.0, elsewhere = 0.0, directError = 0.0, echoError = 0.0;
    for (int frame = 0; frame < 400; ++frame) {
        const double value = rendered->mean(frame) * 0.02, error = rendered->pixelError(frame) * 0.02;
        if (std::abs(frame - direct) <= 1) {
            directSum += value;
            directError += error;
        } else if (std::abs(frame - echo) <= 1) {
            echoSum += value;
            echoError += error;
        } else if (frame < direct) {
            elsewhere += value;
        }
    }
    EXPECT_NEAR(directSum, 0.96 * 0.96 * floor, 4.5 * directError + 1e-3 * floor);
    EXPECT_NEAR(echoSum, 0.96 * 0.96 * 0.04 * 0.04 * floor, 4.5 * echoError);
    EXPECT_LT(echoError, 0.2 * echoSum);
    EXPECT_EQ(elsewhere, 0.0) << "nothing arrives before the direct view";
}

/// Fog behind the camera's back, lit by a lamp there, seen in a mirror ahead; time starts at the scattering, so that
/// all of it lies near the lamp and the mirror does not.
TEST(SpecularTime, UnwarpedFogShowsInAMirrorFarFromTheLight) {
    const std::string scene = R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0, "sigma_s": 0.05}],
        "primitives": [
        {"type": "quad", "bsdf": {"type": "mirror", "albedo": 0.95},
         "transform": {"position": [6, 0, 0], "scale": 6, "rotation": [0, 0, 90]}},
        {"type": "sphere", "bsdf": {"type": "null"}, "emission": 200, "ext_medium": "fog",
         "transform": {"position": [-3, 0.2, 0], "scale": 0.1}}],
        "camera": {"type": "pinhole", "resolution": 1, "fov": 12, "medium": "fog",
                   "transform": {"position": [0, 0, 0], "look_at": [6, 0, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "max_bounces": 5, "transient_time_center": 0.75,
                       "transient_time_width": 0.5, "camera_unwarped": true}})";
    double mean[2], error[2];
    for (const bool guided : {false, true}) {
        const auto rendered = renderPaths(
            scene, {{guided ? "integrator.darts=best" : "integrator.darts=off"}, 64, guided ? 1000u : 4000u, 9});
        mean[guided] = rendered->mean();
        error[guided] = rendered->pixelError();
    }
    EXPECT_NEAR(mean[1], mean[0], 4.5 * std::hypot(error[0], error[1]));
    EXPECT_LT(std::hypot(error[0], error[1]), 0.1 * mean[0]);
}

/// A mirror in thin fog shows a lamp 4 long, whose near end alone is in time: guided paths that aim at the other end
/// meet it, too.
TEST(SpecularTime, GuidedPathsSeeLampsInMirrorsWhicheverPointTheyAimAt) {
    const std::string scene = R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.1, "sigma_a": 0}],
        "primitives": [
        {"type": "quad", "bsdf": {"type": "mirror", "albedo": 0.9}, "ext_medium": "fog",
         "transform": {"scale": [8, 1, 8], "rotation": [0, 0, -45]}},
        {"type": "quad", "bsdf": {"type": "null"}, "emission": 10, "ext_medium": "fog",
         "transform": {"position": [0, -3, 0], "scale": [4, 1, 4], "rotation": [0, 0, 40]}}],
        "camera": {"resolution": 1, "fov": 40, "medium": "fog",
                   "transform": {"position": [-1, 0, 0], "look_at": [0, 0, 0]}},
        "integrator": {"type": "path_tracer", "max_bounces": 8, "transient_time_center": 3,
        "transient_time_width": 0.8}, "renderer": {}})";
    const auto render = [&](const std::string& darts) { return renderPaths(scene, {{darts}, 32, 4000, 3}); };
    const auto plain = render("integrator.darts=off"), guided = render(test::GuidedAlone);
    const double error = std::hypot(plain->pixelError(0), guided->pixelError(0));
    EXPECT_NEAR(guided->mean(), plain->mean(), 4.5 * error);
    EXPECT_LT(error, 0.02 * plain->mean());
}

} // namespace
} // namespace tungsten::path
