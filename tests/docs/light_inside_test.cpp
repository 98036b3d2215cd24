// The walk of docs/extending.md: light that comes from everywhere stays in a body without absorption for 4 V / S on the
// average, whatever scatters there (Blanco and Fournier 2003).

#include "light_inside.h"

#include "support/SceneFile.h"

#include "tungsten/core/Warp.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

TEST(LightInside, StaysForTheMeanChordOfTheBody) {
    const test::SceneFile file(R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 3}],
        "primitives": [{"type": "sphere", "int_medium": "fog", "bsdf": {"type": "forward"}}],
        "camera": {"transform": {"position": [0, 0, 3], "look_at": [0, 0, 0]}}})");
    const LoadedScene loaded = loadScene(file.path(), {{}, {"integrator.type=path_tracer"}});
    const Region& inside = loaded.scene->primitives[0].inside;
    constexpr int Walks = 20000;
    double times = 0.0, squares = 0.0, scatterings = 0.0;
    for (int i = 0; i < Walks; ++i) {
        // Onto the sphere's lowest point, inwards.
        Sampler sampler(1, RandomStream::Test, 0, uint64_t(i));
        const Vec3f up = warp::squareToCosineHemisphere(sampler.next2D());
        const LightInside found = lightInside(*loaded.scene, {{0.0f, 0.0f, -0.9999f}, up}, inside, sampler);
        times += found.time;
        squares += found.time * found.time;
        scatterings += found.scatterings;
    }
    const double mean = times / Walks, error = std::sqrt((squares / Walks - mean * mean) / Walks);
    EXPECT_NEAR(mean, 4.0 / 3.0, 4.0 * error);
    EXPECT_LT(error, 0.02) << "the test would not see a wrong value";
    // A collision for every free flight of length 1 / 3; its noise is that of the times, about.
    EXPECT_NEAR(scatterings / Walks, 3.0 * 4.0 / 3.0, 15.0 * error);
}

} // namespace
} // namespace tungsten
