// Guided flights choose between a surface and the fog before it, without a change of means.

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tungsten::path {
namespace {

/// Fog all around, a lamp in it and a wall behind.
std::unique_ptr<test::Rendered> beforeWall(const std::string& albedo, const std::string& darts,
                                           uint32_t samplesPerPass = 256) {
    return test::renderPaths(R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.3, "sigma_a": 0.02}],
        "camera": {"type": "pinhole", "fov": 20, "resolution": 1, "reconstruction_filter": "box", "medium": "fog",
                   "transform": {"position": [0, 0, -3]}},
        "primitives": [
            {"type": "quad", "bsdf": {"type": "lambert", "albedo": )" +
                                 albedo + R"(}, "int_medium": "fog", "ext_medium": "fog",
             "transform": {"position": [0, 0, 2], "scale": 20, "rotation": [-90, 0, 0]}},
            {"type": "sphere", "emission": 40, "bsdf": {"type": "null"}, "ext_medium": "fog",
             "transform": {"position": [2, 1, 0], "scale": 0.2}}],
        "integrator": {"type": "path_tracer", "max_bounces": 16, "transient_time_center": 8,
                       "transient_time_width": 3, "darts": )" +
                                 darts + "}}",
                             {{}, 64, samplesPerPass});
}

TEST(FlightsToSurfaces, LeaveMeansAsTheyAre) {
    for (const char* albedo : {"0.01", "0.9"}) {
        const auto plain = beforeWall(albedo, R"("off")", 2048);
        EXPECT_LT(plain->pixelError(), 0.03 * plain->mean());
        for (const char* share : {"0", "0.5"}) {
            const auto best = beforeWall(albedo, std::string(R"({"preset": "best", "plain_share": )") + share + "}");
            EXPECT_NEAR(best->mean(), plain->mean(), 4.5 * std::hypot(best->pixelError(), plain->pixelError()))
                << albedo << " " << share;
        }
    }
}

} // namespace
} // namespace tungsten::path
