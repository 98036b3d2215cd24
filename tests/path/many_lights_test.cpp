// Scenes of more than one emitter: each is chosen with a probability, which every way to find its light must know.

#include "path/look_along.h"
#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

/// Looks through thin fog at a lamp of radiance 3 (straight, or in a mirror), beside which there are three others of
/// the same kind.
std::string lampsInThinFog(bool inMirror) {
    const auto lamp = [](const std::string& x, const std::string& z) {
        return R"({"type": "quad", "bsdf": {"type": "null"}, "emission": 3, "ext_medium": "fog",
                   "transform": {"position": [)" +
               x + ", 0, " + z + R"(], "rotation": [90, 0, 0]}},)";
    };
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.02, "sigma_s": 0.01}], "primitives": [)" +
           lamp("0", "0") + lamp("3", "0") + lamp("-3", "0") + lamp("6", "0") +
           R"({"type": "quad", "bsdf": {"type": "mirror"}, "ext_medium": "fog", "int_medium": "fog",
               "transform": {"position": [0, 0, 8], "rotation": [-90, 0, 0]}}],)" +
           test::lookAlong(inMirror ? "[0.1, 0.1, 2]" : "[0.1, 0.1, 4]", inMirror ? "[0.1, 0.1, 8]" : "[0.1, 0.1, 0]",
                           "[0, 1, 0]", "fog") +
           R"(, "integrator": {"type": "path_tracer", "start_time": 0, "transient_time_width": 100, "frame_num": 1}})";
}

TEST(ManyLights, OneOfThemSeenStraightAndInAMirror) {
    for (const bool inMirror : {false, true})
        for (const char* preset : {"off", "published", "best"}) {
            const auto rendered =
                test::renderPaths(lampsInThinFog(inMirror),
                                  {{std::string("integrator.darts=") + preset, "integrator.max_bounces=3"}, 16, 100});
            // 4 or 14 to the lamp; scattered light adds less than the fog scatters.
            const double straight = 3.0 * std::exp(-0.03 * (inMirror ? 14.0 : 4.0)) / 100.0;
            EXPECT_NEAR(rendered->mean(), straight, 5.0 * rendered->pixelError() + 0.02 * straight)
                << preset << inMirror;
            EXPECT_LT(rendered->pixelError(), 0.03 * straight) << preset;
        }
}

/// Looks over a floor through thin fog, which shows the light of four lamps that the floor reflects: guided paths find
/// it by light paths of single lamps, whose pulses start together or (`apart`) one after the other.
void expectLightFromAFloor(double apart, const std::string& gate) {
    int lamps = 0;
    const auto lamp = [&](const std::string& x, const std::string& z) {
        return R"({"type": "sphere", "bsdf": {"type": "null"}, "emission": 20, "ext_medium": "fog", "emission_time": )" +
               std::to_string(apart * lamps++) + R"(, "transform": {"position": [)" + x + ", 1.5, " + z +
               R"(], "scale": 0.2}},)";
    };
    std::string json =
        R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.05, "sigma_s": 0.05}], "primitives": [)";
    json += lamp("1", "0");
    json += lamp("-1", "0");
    json += lamp("0", "1");
    json += lamp("0", "-1");
    json +=
        R"({"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.8}, "ext_medium": "fog", "transform": {"scale": 8}}],)" +
        test::lookAlong("[0, 0.5, 4]", "[0, 0.5, 0]", "[0, 1, 0]", "fog") +
        R"(, "integrator": {"type": "path_tracer", "min_bounces": 2, "max_bounces": 3, )" + gate + "}}";
    const auto plain = test::renderPaths(json, {{"integrator.darts=off"}, 64, 2000}),
               guided = test::renderPaths(json, {{"integrator.darts=best"}, 64, 500});
    const double error = std::hypot(plain->pixelError(), guided->pixelError());
    EXPECT_NEAR(guided->mean(), plain->mean(), 4.5 * error);
    EXPECT_LT(error, 0.05 * plain->mean()) << "the test would not see a wrong value";
}

TEST(ManyLights, ShownByFogAboveAFloor) {
    expectLightFromAFloor(0.0, R"("transient_time_center": 7, "transient_time_width": 3)");
}

TEST(ManyLights, PulsesOfDifferentTimesShownByFogAboveAFloor) {
    expectLightFromAFloor(1.5, R"("transient_time_center": 10, "transient_time_width": 2)");
}

} // namespace
} // namespace tungsten::path
