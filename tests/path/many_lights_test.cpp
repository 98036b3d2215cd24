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

} // namespace
} // namespace tungsten::path
