// Light from outside a body: guided paths against the diffusion limit and against plain paths.

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

const std::string GuidedAlone = R"(integrator.darts={"plain_share": 0})";

using test::renderPaths;

/// A block of unit mean free path, 60 wide, lit and seen from far above; frames of 10 from `start` after the light that
/// its surface would reflect at once.
std::string blockScene(double thickness, bool fromBehind, double start, int frames) {
    const double lamp = fromBehind ? -1000.0 - thickness : 1000.0, least = 1100.0 + (fromBehind ? thickness : 0.0);
    std::ostringstream json;
    json << R"({"media": [{"name": "block", "type": "homogeneous", "sigma_s": 1, "sigma_a": 0.002}],
        "primitives": [{"type": "cube", "int_medium": "block", "bsdf": {"type": "forward"},
                        "transform": {"position": [0, 0, )"
         << -0.5 * thickness << R"(], "scale": [60, 60, )" << thickness << R"(]}},
                       {"type": "point", "emission": 1e6, "transform": {"position": [0, 0, )"
         << lamp << R"(]}}],
        "camera": {"type": "pinhole", "fov": 0.5, "resolution": 1, "transform": {"position": [0, 0, 100],
                   "look_at": [0, 0, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "max_bounces": 1024, "darts": "best", "start_time": )"
         << least + start << R"(, "transient_time_width": 10, "frame_num": )" << frames << R"(}, "renderer": {}})";
    return json.str();
}

constexpr double Absorption = 0.002, Diffusivity = 1.0 / (3.0 * (1.0 + Absorption)), Extrapolated = 2.0 * Diffusivity;

/// Patterson, Chance and Wilson 1989, over all of the surface: uniform light reflected after the length s, per length.
double reflectance(double s) {
    const auto source = [&](double z) { return z * std::exp(-z * z / (4.0 * Diffusivity * s)); };
    return 0.5 / std::sqrt(4.0 * M_PI * Diffusivity * s * s * s) * std::exp(-Absorption * s) *
           (source(1.0) + source(1.0 + 2.0 * Extrapolated));
}

TEST(Bodies, AHalfSpacesReflectanceDecaysAsInTheDiffusionLimit) {
    const auto rendered = renderPaths(blockScene(30.0, false, 20.0, 4), {{}, 1024, 16, 5});
    const auto expected = [](int frame) {
        double sum = 0.0;
        for (int i = 0; i < 100; ++i) sum += reflectance(20.0 + 10.0 * frame + 0.1 * (i + 0.5));
        return sum / 100.0;
    };
    for (const int frame : {1, 2, 3}) {
        const double ratio = rendered->mean(frame) / rendered->mean(0), exact = expected(frame) / expected(0);
        const double error = ratio * std::hypot(rendered->pixelError(frame) / rendered->mean(frame),
                                                rendered->pixelError(0) / rendered->mean(0));
        EXPECT_NEAR(ratio, exact, 4.5 * error + 0.03 * exact) << frame;
        EXPECT_LT(error, 0.05 * exact) << frame; // the comparison says something
    }
}

TEST(Bodies, ASlabsTransmittanceDecaysWithItsLowestMode) {
    constexpr double Thickness = 6.0;
    const auto rendered = renderPaths(blockScene(Thickness, true, 40.0, 3), {{}, 1024, 64, 6});
    const double wide = Thickness + 2.0 * Extrapolated, rate = Absorption + Diffusivity * M_PI * M_PI / (wide * wide);
    for (const int frame : {1, 2}) {
        const double ratio = rendered->mean(frame) / rendered->mean(0), exact = std::exp(-10.0 * frame * rate);
        const double error = ratio * std::hypot(rendered->pixelError(frame) / rendered->mean(frame),
                                                rendered->pixelError(0) / rendered->mean(0));
        EXPECT_NEAR(ratio, exact, 4.5 * error + 0.03 * exact) << frame;
        EXPECT_LT(error, 0.08 * exact) << frame;
    }
}

/// A small dense cube, milk or tissue, in nothing or in haze, from afar.
std::string cubeScene(const std::string& medium, const std::string& haze) {
    const std::string outside = haze.empty() ? "" : R"("ext_medium": "haze", )";
    return R"({"media": [{"name": "milk", "type": "homogeneous", )" + medium + "}" +
           (haze.empty() ? ""
                         : R"(, {"name": "haze", "type": "homogeneous", "sigma_a": 0.001, "sigma_s": )" + haze + "}") +
           R"(], "primitives": [{"type": "cube", "int_medium": "milk", )" + outside + R"("bsdf": {"type": "forward"}},
               {"type": "point", "emission": 1, )" +
           outside + R"("transform": {"position": [1, 2, 1.5]}}],
              "camera": {"type": "pinhole", "fov": 14, "resolution": 3, )" +
           (haze.empty() ? "" : R"("medium": "haze", )") + R"("transform": {"position": [0, 0.5, 4],
                         "look_at": [0, 0, 0], "up": [0, 1, 0]}},
              "integrator": {"type": "path_tracer", "max_bounces": 256, "transient_time_center": 6.5,
                             "transient_time_width": 1.0}, "renderer": {}})";
}

TEST(Bodies, GuidedPathsAgreeWithPlainOnesSeenFromAfar) {
    struct Case {
        std::string medium, haze;
    };
    const Case cases[] = {
        {R"("sigma_s": 30, "sigma_a": 0.1)", ""},
        {R"("sigma_s": 30, "sigma_a": 0.1)", "0.1"},
        {R"("sigma_s": 100, "sigma_a": 0.1, "phase_function": {"type": "henyey_greenstein", "g": 0.8})", ""},
        {R"("sigma_s": [30, 25, 20], "sigma_a": [0.1, 2, 5])", ""}};
    for (const Case& c : cases) {
        const std::string scene = cubeScene(c.medium, c.haze);
        double mean[2], error[2];
        for (const bool guided : {false, true}) {
            const auto rendered =
                renderPaths(scene, {{guided ? GuidedAlone : "integrator.darts=off"}, guided ? 48u : 128u, 16, 7});
            const Image variance = rendered->film.standardError(0);
            double sum = 0.0;
            for (const Rgb& pixel : variance.pixels) sum += double(meanComponent(pixel)) * double(meanComponent(pixel));
            mean[guided] = rendered->mean();
            error[guided] = std::sqrt(sum) / 9.0;
        }
        EXPECT_NEAR(mean[1], mean[0], 4.5 * std::hypot(error[0], error[1])) << c.medium << " " << c.haze;
        EXPECT_LT(std::hypot(error[0], error[1]), 0.1 * mean[0]) << c.medium << " " << c.haze;
    }
}

/// Light leaves a slow ball 2.5 times as fast, and would be too late all the way at the speed inside.
TEST(Bodies, GuidedPathsAgreeWithPlainOnesOutOfSlowOnes) {
    const std::string scene = R"({"media": [{"name": "milk", "type": "homogeneous", "sigma_s": 20, "sigma_a": 0.01,
                                             "speed_of_light": 0.4}],
      "primitives": [{"type": "sphere", "int_medium": "milk", "bsdf": {"type": "forward"}, "transform": {"scale": 0.8}},
                     {"type": "disk", "emission": 40, "bsdf": {"type": "null"},
                      "transform": {"position": [1.5, 1.5, 2], "rotation": [130, 30, 0], "scale": 1.2}}],
      "camera": {"resolution": 1, "fov": 20, "transform": {"position": [0, 0, 4], "look_at": [0, 0, 0]}},
      "integrator": {"type": "path_tracer", "max_bounces": 256, "transient_time_center": 6.6,
                     "transient_time_width": 0.3}, "renderer": {}})";
    const auto render = [&](const std::string& darts, uint32_t samples) {
        return renderPaths(scene, {{darts}, 32, samples, 5});
    };
    const auto plain = render("integrator.darts=off", 20000), guided = render(GuidedAlone, 20000);
    const double error = std::hypot(plain->pixelError(0), guided->pixelError(0));
    EXPECT_NEAR(guided->mean(), plain->mean(), 4.5 * error);
    EXPECT_LT(error, 0.01 * plain->mean());
}

/// A cube of milk under a lamp as large, of which half the points face away and few let light arrive in a short gate.
std::string underALamp(double width) {
    std::ostringstream json;
    json << R"({"media": [{"name": "milk", "type": "homogeneous", "sigma_s": 40, "sigma_a": 0.1}],
        "primitives": [{"type": "cube", "int_medium": "milk", "bsdf": {"type": "forward"}},
                       {"type": "sphere", "bsdf": {"type": "null"}, "emission": 10,
                        "transform": {"position": [1, 2, 1.5], "scale": 0.5}}],
        "camera": {"type": "pinhole", "fov": 14, "resolution": 3, "transform": {"position": [0, 0.5, 4],
                   "look_at": [0, 0, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "max_bounces": 512, "transient_time_center": 6,
                       "transient_time_width": )"
         << width << R"(}, "renderer": {}})";
    return json.str();
}

TEST(Bodies, UnderALampInGatesOfAnyWidth) {
    for (const double width : {0.05, 0.5}) { // 2 and 20 transport mean free paths
        double mean[2], error[2];
        for (const bool guided : {false, true}) {
            const auto rendered = renderPaths(
                underALamp(width), {{guided ? GuidedAlone : "integrator.darts=off"}, guided ? 64u : 512u, 16, 8});
            mean[guided] = rendered->mean();
            error[guided] = rendered->pixelError(0) / 3.0;
            for (const char* counter : {"control vertices", "points of emitters compared"})
                EXPECT_EQ(rendered->statistics.counter(counter) > 0, guided) << counter;
        }
        EXPECT_NEAR(mean[1], mean[0], 4.5 * std::hypot(error[0], error[1])) << width;
        EXPECT_LT(std::hypot(error[0], error[1]), 0.1 * mean[0]) << width;
    }
}

/// The corner between a layer of fog, one mean free path deep, and a block of the same that is 30 high.
constexpr auto Corner = R"(v 0 -10 0
v 2 -10 0
v 12 -10 0
v 12 -10 1
v 2 -10 1
v 2 -10 30
v 0 -10 30
v 0 10 0
v 2 10 0
v 12 10 0
v 12 10 1
v 2 10 1
v 2 10 30
v 0 10 30
f 8 9 2 1
f 9 10 3 2
f 10 11 4 3
f 11 12 5 4
f 12 13 6 5
f 13 14 7 6
f 14 8 1 7
f 2 6 7 1
f 3 4 5 2
f 14 13 9 8
f 12 11 10 9
)";

TEST(Bodies, GuidedControlVerticesThatRouletteKeepsAreWeighedUp) {
    // Light from above that scatters twice, seen along the block's foot: from there the way to the lamp leads up
    // through the block, but control vertices in the layer beside it are just under its surface.
    const test::FileFolder folder;
    folder.write("corner.obj", Corner);
    const auto scene = folder.write("scene.json", R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 1}],
        "primitives": [{"type": "mesh", "file": "corner.obj", "int_medium": "fog", "bsdf": {"type": "forward"}},
                       {"type": "point", "emission": 1e6, "transform": {"position": [6, 0, 1000]}}],
        "camera": {"type": "pinhole", "fov": 0.2, "resolution": 1, "transform": {"position": [1.5, -100, 0.4],
                   "look_at": [1.5, 0, 0.4], "up": [0, 0, 1]}},
        "integrator": {"type": "path_tracer", "min_bounces": 4, "max_bounces": 5, "transient_time_center": 1094,
                       "transient_time_width": 8}, "renderer": {}})");
    const auto plain = test::renderPathFile(scene, {{"integrator.darts=off"}, 16, 5000, 9});
    const auto guided = test::renderPathFile(scene, {{GuidedAlone}, 16, 12000, 9});
    EXPECT_GT(guided->statistics.counter("control vertices"), 0u);
    const double error = std::hypot(plain->pixelError(), guided->pixelError());
    EXPECT_NEAR(guided->mean(), plain->mean(), 4.5 * error);
    EXPECT_LT(error, 0.03 * plain->mean()); // without their weight 42 % would be missing
}

} // namespace
} // namespace tungsten::path
