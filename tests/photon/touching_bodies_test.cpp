// Bodies that touch: what they show is what they show with a gap that is far longer than rounding and far shorter than
// a mean free path. Every way from the light to the camera crosses the faces at one place, by paths, light paths and
// photons alike.

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tungsten::test {
namespace {

const std::string Scene = R"({
  "media": [
    {"name": "thin", "type": "homogeneous", "sigma_s": 2.0, "sigma_a": 0.05, "phase_function": {"type": "isotropic"}},
    {"name": "dense", "type": "homogeneous", "sigma_s": 5.0, "sigma_a": 0.3,
     "phase_function": {"type": "henyey_greenstein", "g": 0.5}}],
  "primitives": [
    {"type": "quad", "emission": 10, "bsdf": {"type": "null"},
     "transform": {"position": [0, 0.7, 0.1], "rotation": [180, 0, 0], "scale": 1.6}},
    PRIMITIVES],
  "camera": {"resolution": 1, "fov": 10, "reconstruction_filter": "box",
             "transform": {"position": [0.3, 0.3, 5], "look_at": [0, 0.1, 0]}},
  "integrator": {"type": "progressive_photon_map", "max_bounces": 48, "photon_count": 1000, "volume_photon_count": 5000,
                 "gather_photon_count": 100, "gather_radius": 0.2, "volume_gather_radius": 0.2},
  "renderer": {}})";

struct Touching {
    const char* name;
    const char* primitives;
    std::vector<std::string> gap; ///< overrides that part them
};

const Touching Cases[] = {
    {"BesideEachOther",
     R"({"type": "cube", "int_medium": "thin", "bsdf": {"type": "forward"}, "transform": {"position": [-0.5, 0, 0]}},
        {"name": "moved", "type": "cube", "int_medium": "dense", "bsdf": {"type": "forward"},
         "transform": {"position": [0.5, 0, 0]}})",
     {"primitives.moved.transform.position=[0.5002,0,0]"}},
    {"OneInTheOther",
     R"({"name": "moved", "type": "cube", "int_medium": "dense", "ext_medium": "thin", "bsdf": {"type": "forward"},
         "transform": {"position": [0, 0.2, 0.2], "scale": 0.6}},
        {"type": "cube", "int_medium": "thin", "bsdf": {"type": "forward"}})",
     {"primitives.moved.transform.position=[0,0.1998,0.1998]"}},
    {"GlassOnFog",
     R"({"type": "cube", "int_medium": "dense", "bsdf": {"type": "forward"},
         "transform": {"position": [0, -0.1, 0], "scale": [1, 0.8, 1]}},
        {"name": "moved", "type": "cube", "bsdf": {"type": "dielectric", "ior": 1.4},
         "transform": {"position": [0, 0.4, 0], "scale": [1, 0.2, 1]}})",
     {"primitives.moved.transform.position=[0,0.4002,0]"}},
    {"FogOnAFloor",
     R"({"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.8}, "transform": {"position": [0, -0.2, 0], "scale": 4}},
        {"name": "moved", "type": "cube", "int_medium": "thin", "bsdf": {"type": "forward"},
         "transform": {"position": [0, 0.1, 0], "scale": [1.5, 0.6, 1.5]}})",
     {"primitives.moved.transform.position=[0,0.1002,0]"}},
};

void PrintTo(const Touching& touching, std::ostream* out) {
    *out << touching.name;
}

class TouchingBodies : public testing::TestWithParam<Touching> {
  protected:
    /// Renders with and without the gap, by other random numbers, and compares them.
    template <typename Render>
    void expectSame(const Render& render, RenderOptions options, double largestError) const {
        std::string scene = Scene;
        scene.replace(scene.find("PRIMITIVES"), 10, GetParam().primitives);
        const auto touching = render(scene, options);
        options.seed = 2;
        options.overrides.insert(options.overrides.end(), GetParam().gap.begin(), GetParam().gap.end());
        const auto parted = render(scene, options);
        ASSERT_GT(parted->mean(), 0.0);
        const double ratio = touching->mean() / parted->mean();
        const double error = std::hypot(touching->pixelError(), parted->pixelError()) / parted->mean();
        EXPECT_LT(error, largestError) << "too noisy to be a proof";
        EXPECT_NEAR(ratio, 1.0, 4.0 * error);
        RecordProperty("ratio", std::to_string(ratio) + " +- " + std::to_string(error));
    }
};

TEST_P(TouchingBodies, ByPaths) {
    expectSame(renderPaths, {.overrides = {}, .passes = 32, .samplesPerPass = 4096}, 0.01);
}
TEST_P(TouchingBodies, ByLightPaths) {
    expectSame(renderLight, {.overrides = {"integrator.type=light_tracer"}, .passes = 32, .samplesPerPass = 4096},
               0.02);
}
TEST_P(TouchingBodies, ByPhotons) {
    expectSame(renderPhotons, {.overrides = {}, .passes = 32, .samplesPerPass = 256}, 0.05);
}
INSTANTIATE_TEST_SUITE_P(Bodies, TouchingBodies, testing::ValuesIn(Cases),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace tungsten::test
