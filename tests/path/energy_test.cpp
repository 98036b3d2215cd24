// Closed rooms that glow: a wall of emission E and albedo rho is seen with radiance E sum rho^k, fog without absorption
// or not.

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

using test::renderPaths;

/// Six glowing walls (emission 0.5) of one BSDF around [-1, 1] x [0, 2] x [-1, 1]; the camera is in the middle, in
/// `medium`.
std::string glowingRoom(const std::string& bsdf, const std::string& medium, const std::string& integrator) {
    std::string walls;
    for (const char* placed :
         {R"("position": [0, 0, 0])", R"("position": [0, 2, 0], "rotation": [180, 0, 0])",
          R"("position": [0, 1, -1], "rotation": [90, 0, 0])", R"("position": [0, 1, 1], "rotation": [-90, 0, 0])",
          R"("position": [-1, 1, 0], "rotation": [0, 0, -90])", R"("position": [1, 1, 0], "rotation": [0, 0, 90])"})
        walls += std::string(walls.empty() ? "" : ", ") + R"({"type": "quad", "emission": 0.5, "bsdf": )" + bsdf +
                 R"(, "transform": {"scale": 2, )" + placed + "}}";
    return R"({"media": [{"name": "cloud", "type": "homogeneous", "sigma_s": 1},
                         {"name": "smoke", "type": "homogeneous", "sigma_a": [0.5, 1, 2]}],
     "primitives": [)" +
           walls + R"(], "camera": {"type": "pinhole", "resolution": [2, 2], "fov": 80, )" +
           (medium.empty() ? "" : R"("medium": ")" + medium + R"(", )") +
           R"("transform": {"position": [0, 1, 0], "look_at": [0.3, 0.8, -1]}},
     "integrator": {"type": "path_tracer", )" +
           integrator + "}}";
}

void expectUniform(const test::Rendered& rendered, double expected, double largestError) {
    const Image mean = rendered.film.mean(0), error = rendered.film.standardError(0);
    for (size_t i = 0; i < mean.pixels.size(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(double(mean.pixels[i][channel]), expected, 4.5 * double(error.pixels[i][channel]) + 1e-4);
            EXPECT_LT(double(error.pixels[i][channel]), largestError * expected);
        }
}

TEST(Energy, RoomWithAFixedNumberOfBounces) {
    const std::string lambert = R"({"type": "lambert", "albedo": 0.6})";
    for (const std::string sampling : {"true", "false"}) {
        const std::string integrator = R"("enable_rr": false, "max_bounces": 5, "enable_light_sampling": )" + sampling;
        expectUniform(*renderPaths(glowingRoom(lambert, "", integrator), {{}, 50, 100}),
                      0.5 * (1.0 - std::pow(0.6, 5)) / 0.4, 0.01);
    }
}

std::string whiteRoomOfTenThousandBounces(const std::string& medium) {
    return glowingRoom(R"({"type": "lambert", "albedo": 1})", medium,
                       R"("enable_rr": false, "max_bounces": 10000, "enable_light_sampling": false,
                          "enable_volume_light_sampling": false)");
}

/// Walls of albedo 1 are met as often as there are bounces, of which fog takes its share: the mean chord is 4 V / S. A
/// throughput that drifts by 10^-7 a bounce shows in all pixels, light that gets out by corners in some.
TEST(Energy, IsKeptOverTenThousandBounces) {
    constexpr double Bounces = 10000.0, MeanChord = 4.0 * 8.0 / 24.0, SigmaS = 1.0;
    for (const std::string medium : {"", "cloud"}) {
        const auto rendered = renderPaths(whiteRoomOfTenThousandBounces(medium), {{}, 6, 16});
        const double expected = 0.5 * Bounces / (medium.empty() ? 1.0 : 1.0 + SigmaS * MeanChord);
        if (medium.empty()) {
            for (const Rgb& pixel : rendered->film.mean(0).pixels)
                EXPECT_NEAR(double(pixel.x) / expected, 1.0, 1e-4) << "of 96 paths";
        }
        EXPECT_NEAR(rendered->mean() / expected, 1.0, 4.5 * rendered->pixelError() / expected + 1e-4) << medium;
        EXPECT_LT(rendered->pixelError() / expected, 1e-3) << medium;
    }
}

/// 640 000 equal contributions to a pixel of one pass: sums of floats were 0.5 % off.
TEST(Energy, IsSummedWithoutDriftWithinAPass) {
    const auto rendered = renderPaths(whiteRoomOfTenThousandBounces(""), {{"camera.resolution=[1, 1]"}, 1, 64});
    EXPECT_NEAR(rendered->mean() / 5000.0, 1.0, 1e-6);
}

/// Emitters seen in a mirror cannot be connected to: what the walk finds there counts in full.
TEST(Energy, RoomOfHalfMirrors) {
    const std::string mixed = R"({"type": "mixed", "ratio": 0.5, "bsdf0": {"type": "mirror", "albedo": 0.6},
                                  "bsdf1": {"type": "lambert", "albedo": 0.6}})";
    expectUniform(*renderPaths(glowingRoom(mixed, "", R"("enable_rr": false, "max_bounces": 5)"), {{}, 50, 200}),
                  0.5 * (1.0 - std::pow(0.6, 5)) / 0.4, 0.01);
}

/// Two distances per surface are enough in thin fog, however many surfaces a path meets.
TEST(Energy, MediumLimitsStartAnewAtSurfaces) {
    expectUniform(*renderPaths(glowingRoom(R"({"type": "lambert", "albedo": 0.6})", "cloud",
                                           R"("enable_rr": false, "max_bounces": 6)"),
                               {{"media.0.max_bounces=2", "media.0.sigma_s=1e-7"}, 50, 100}),
                  0.5 * (1.0 - std::pow(0.6, 6)) / 0.4, 0.01);
}

TEST(Energy, RoomWithRussianRoulette) {
    expectUniform(
        *renderPaths(glowingRoom(R"({"type": "lambert", "albedo": 0.6})", "", R"("max_bounces": 1000)"), {{}, 50, 100}),
        0.5 / 0.4, 0.01);
}

TEST(Energy, NonAbsorbingFogChangesNothing) {
    for (const std::string sampling : {"true", "false"}) {
        const std::string integrator =
            R"("max_bounces": 1000, "enable_light_sampling": true, "enable_volume_light_sampling": )" + sampling;
        expectUniform(
            *renderPaths(glowingRoom(R"({"type": "lambert", "albedo": 0.5})", "cloud", integrator), {{}, 50, 100}),
            0.5 / 0.5, 0.02);
    }
}

TEST(Energy, SmokeOnlyAttenuates) {
    const auto rendered = renderPaths(glowingRoom(R"({"type": "null"})", "smoke", R"("max_bounces": 1)"),
                                      {{"camera.resolution=[1, 1]", "camera.fov=0.01",
                                        "camera.transform={\"position\": [0, 1, 0.5], \"look_at\": [0, 1, -1]}"},
                                       1,
                                       4});
    const Rgb mean = rendered->film.mean(0).at(0, 0);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(mean[channel], 0.5f * std::exp(-1.5f * (channel == 0 ? 0.5f : float(channel))), 1e-4f);
}

/// Whatever a surface is made of, connections change the noise and not the mean.
TEST(Energy, ConnectionsDoNotChangeTheMean) {
    for (
        const std::string bsdf :
        {R"({"type": "plastic", "albedo": 0.5})", R"({"type": "rough_conductor", "material": "Al", "roughness": 0.3})",
         R"({"type": "rough_plastic", "albedo": 0.5, "roughness": 0.2})",
         R"({"type": "rough_dielectric", "roughness": 0.3})",
         R"({"type": "mixed", "bsdf0": {"type": "mirror"}, "bsdf1": {"type": "lambert", "albedo": 0.5}, "ratio": 0.4})",
         R"({"type": "transparency", "alpha": 0.6, "base": {"type": "lambert", "albedo": 0.7}})"}) {
        const auto value = [&](const std::string& sampling) {
            return renderPaths(R"({"primitives": [{"type": "cube", "bsdf": )" + bsdf +
                                   R"(, "transform": {"rotation": [30, 20, 0]}},
                     {"type": "sphere", "emission": [20, 10, 5], "bsdf": {"type": "null"}, "transform": {"position": [1, 2, 1], "scale": 0.6}},
                     {"type": "infinite_sphere", "emission": 0.3}],
                    "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 10, "transform": {"position": [0, 0, 4], "look_at": [0, 0, 0]}},
                    "integrator": {"type": "path_tracer", "max_bounces": 6, "enable_light_sampling": )" +
                                   sampling + "}}",
                               {{}, 100, 300});
        };
        const auto with = value("true"), without = value("false");
        const double error = std::hypot(with->pixelError(), without->pixelError());
        EXPECT_NEAR(with->mean(), without->mean(), 4.5 * error) << bsdf;
        EXPECT_LT(error, 0.04 * with->mean()) << bsdf;
    }
}

/// A pulse in a closed white box of fog, late: what diffusion's slowest modes have left. Guided walks of 120
/// scatterings must not let few of them carry everything.
TEST(Energy, GuidedPathsFillAClosedWhiteBox) {
    const double time = 15.0, light = -0.4, camera = 0.9, sigmaS = 8.0;
    const auto rendered = renderPaths(
        R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 8}],
            "primitives": [{"type": "cube", "bsdf": {"type": "lambert", "albedo": 1}, "int_medium": "fog", "transform": {"scale": 2}},
                           {"type": "point", "power": 100.530965, "ext_medium": "fog", "int_medium": "fog",
                            "transform": {"position": [0.3, 0.2, -0.4]}}],
            "camera": {"type": "pinhole", "resolution": [2, 2], "fov": 20, "medium": "fog",
                       "transform": {"position": [0, 0, 0.9], "look_at": [0, 0, -0.5]}},
            "integrator": {"type": "path_tracer", "max_bounces": 100000, "transient_time_center": 15,
                           "transient_time_width": 2, "darts": "best"}})",
        {{}, 90, 40});
    // Of the source seen one mean free path ahead; the next modes are below 1 % by then.
    const double k = M_PI / 2.0, diffusivity = 1.0 / (3.0 * sigmaS), seen = camera - 1.0 / sigmaS;
    const double expected =
        1.0 + 2.0 * std::cos(k * (light + 1.0)) * std::cos(k * (seen + 1.0)) * std::exp(-diffusivity * k * k * time);
    EXPECT_NEAR(rendered->mean(), expected, 4.5 * rendered->pixelError() + 0.03 * expected);
    EXPECT_LT(rendered->pixelError(), 0.08 * expected);
}

} // namespace
} // namespace tungsten::path
