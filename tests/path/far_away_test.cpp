// An image does not change with what is far away, nor with where the scene is.

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

std::string at(double offset, double x, double y, double z) {
    return "[" + std::to_string(x + offset) + ", " + std::to_string(y) + ", " + std::to_string(z + offset) + "]";
}

/// A block with a glowing ball beside it on a ground of the given size, moved by `offset` along x and z.
std::string blockOnGround(double size, double offset) {
    const std::string side = std::to_string(size);
    return R"({"primitives": [
        {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.6},
         "transform": {"position": )" +
           at(offset, 0, 0, 0) + R"(, "scale": [)" + side + ", 1, " + side + R"(]}},
        {"type": "cube", "bsdf": {"type": "lambert", "albedo": 0.6},
         "transform": {"position": )" +
           at(offset, 0, 0.15, 0) + R"(, "scale": 0.3}},
        {"type": "sphere", "bsdf": {"type": "null"}, "emission": 40,
         "transform": {"position": )" +
           at(offset, 0.9, 0.5, 0.2) + R"(, "scale": 0.08}}],
        "camera": {"type": "pinhole", "resolution": [12, 12], "fov": 20, "reconstruction_filter": "box",
                   "transform": {"position": )" +
           at(offset, 0, 2, 0.8) + R"(, "look_at": )" + at(offset, 0, 0, 0) +
           R"(, "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "max_bounces": 6, "darts": "off", "transient_time_center": 3.2,
                       "transient_time_width": 1.2}})";
}

/// With the same random numbers: what differs is rounding.
double meanOf(double size, double offset) {
    return test::renderPaths(blockOnGround(size, offset), {{}, 1, 128})->mean();
}

TEST(FarAway, AVastGroundAndAPlaceFarFromTheOriginChangeNothing) {
    const double near = meanOf(4.0, 0.0);
    EXPECT_GT(near, 0.05);
    EXPECT_NEAR(meanOf(40000.0, 0.0), near, 1e-4 * near);
    // There floats are 1e-3 apart, 1/300 of the block.
    EXPECT_NEAR(meanOf(4.0, 1e4), near, 1e-2 * near);
}

} // namespace
} // namespace tungsten::path
