// Direct light on a Lambert floor: closed forms, and each arrival in the right frame.

#include "path/look_along.h"
#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

using test::renderPaths;

/// A floor of albedo 0.5 seen from (0.75, 2, 0) straight below; `lights` are primitives, `integrator` its fields.
std::string floorUnder(const std::string& lights, const std::string& integrator) {
    return R"({"primitives": [{"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5},
                               "transform": {"scale": [20, 1, 20]}}, )" +
           lights + "]," + test::lookAlong("[0.75, 2, 0]", "[0.75, 0, 0]", "[1, 0, 0]") +
           R"(, "integrator": {"type": "path_tracer", "max_bounces": 2, "min_bounces": 1, )" + integrator + "}}";
}
constexpr double Reflectance = 0.5 / M_PI;

TEST(DirectLight, SpotWithItsSmoothEdge) {
    const auto rendered = renderPaths(
        floorUnder(R"({"type": "spot", "emission": 3, "cone_angle": 50, "edge_angle": 20, "emission_time": 0.6,
                       "transform": {"position": [0, 1, 0], "look_at": [0, 0, 0], "up": [1, 0, 0]}})",
                   R"("start_time": 0, "transient_time_width": 0.25, "frame_num": 20)"),
        {{}, 2, 4});
    // Seen from the spot the point lies 36.9 degrees off axis, between the full cone (30) and its end (50).
    const double inner = std::cos(M_PI / 6.0), outer = std::cos(50.0 * M_PI / 180.0);
    const double x = (0.8 - outer) / (inner - outer);
    const double expected = Reflectance * 3.0 * x * x * (3.0 - 2.0 * x) * 0.8 / (1.25 * 1.25) / 0.25;
    for (int frame = 0; frame < 20; ++frame) // 0.6 + 1.25 + 2
        EXPECT_NEAR(rendered->mean(frame), frame == 15 ? expected : 0.0, 1e-3 * expected) << frame;
}

TEST(DirectLight, NarrowGateCatchesTheExactArrival) {
    const std::string light = R"({"type": "point", "emission": 3, "transform": {"position": [0, 1, 0]}})";
    const double flux = Reflectance * 3.0 * 0.8 / (1.25 * 1.25);
    const auto value = [&](double centre) {
        return renderPaths(floorUnder(light, R"("transient_time_width": 2e-5, "transient_time_center": )" +
                                                 std::to_string(centre)),
                           {{}, 1, 1})
            ->mean();
    };
    EXPECT_NEAR(value(3.25), flux / 2e-5, 1e-3 * flux / 2e-5);
    EXPECT_EQ(value(3.25 - 3e-5), 0.0);
    EXPECT_EQ(value(3.25 + 3e-5), 0.0);
}

TEST(DirectLight, PulsesOfTwoLightsArriveApart) {
    const auto rendered =
        renderPaths(floorUnder(R"({"type": "point", "emission": 3, "transform": {"position": [0, 1, 0]}},
                      {"type": "point", "emission": [1, 2, 4], "emission_time": 2.3, "transform": {"position": [0.75, 1, 0]}})",
                               R"("start_time": 0, "transient_time_width": 0.5, "frame_num": 12)"),
                    {{}, 50, 200});
    const double first = Reflectance * 3.0 * 0.8 / (1.25 * 1.25) / 0.5, second = Reflectance / 0.5;
    for (int frame = 0; frame < 12; ++frame) {
        const Rgb mean = rendered->film.mean(frame).at(0, 0), error = rendered->film.standardError(frame).at(0, 0);
        for (int channel = 0; channel < 3; ++channel) {
            const double colour = channel == 0 ? 1.0 : channel == 1 ? 2.0 : 4.0;
            const double expected = frame == 6 ? first : frame == 10 ? second * colour : 0.0; // 3.25 and 2.3 + 1 + 2
            EXPECT_NEAR(double(mean[channel]), expected, 4.5 * double(error[channel])) << frame;
            EXPECT_LE(double(error[channel]), 0.02 * expected) << frame;
        }
    }
}

/// Irradiance of a Lambertian sphere (radiance 2, radius R at distance d) from the part of it whose points lie less
/// than `reach` away: with mu the cosine to its axis at distance t, mu = (t^2 + d^2 - R^2) / 2dt, E = pi L cos (1 -
/// mu^2).
double sphereIrradiance(double reach) {
    constexpr double Radius = 0.2, Distance = 1.25, Cosine = 0.8;
    const double t = std::clamp(reach, Distance - Radius, std::sqrt(Distance * Distance - Radius * Radius));
    const double mu = (t * t + Distance * Distance - Radius * Radius) / (2.0 * Distance * t);
    return M_PI * 2.0 * Cosine * (1.0 - mu * mu);
}

TEST(DirectLight, SphereFrameByFrameWithAndWithoutLightSampling) {
    constexpr double Width = 0.03;
    for (const std::string sampling : {"true", "false"}) {
        const auto rendered = renderPaths(
            floorUnder(
                R"({"type": "sphere", "emission": 2, "emission_time": 0.5, "bsdf": {"type": "null"},
                    "transform": {"position": [0, 1, 0], "scale": 0.2}})",
                R"("start_time": 3.5, "transient_time_width": 0.03, "frame_num": 10, "enable_light_sampling": )" +
                    sampling),
            {{}, 100, 3000});
        for (int frame = 0; frame < 10; ++frame) {
            const double reach = 1.0 + frame * Width; // the camera is 2 away
            const double expected = Reflectance * (sphereIrradiance(reach + Width) - sphereIrradiance(reach)) / Width;
            EXPECT_NEAR(rendered->mean(frame), expected, 4.5 * rendered->pixelError(frame) + 1e-4)
                << "frame " << frame << " light sampling " << sampling;
            EXPECT_LE(rendered->pixelError(frame), 0.15 * expected + 1e-4);
        }
    }
}

TEST(DirectLight, QuadOverheadWithAndWithoutLightSampling) {
    // Form factor from a point to a parallel unit square centred above it at height 1: four corners of 1/2 x 1/2.
    const double a = 0.5, root = std::sqrt(1.0 + a * a);
    const double formFactor = 4.0 / (2.0 * M_PI) * 2.0 * (a / root) * std::atan(a / root);
    for (const std::string sampling : {"true", "false"}) {
        const auto rendered = renderPaths(
            R"({"primitives": [{"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5}, "transform": {"scale": [20, 1, 20]}},
                 {"type": "quad", "emission": 2, "bsdf": {"type": "null"}, "transform": {"position": [0, 1, 0], "rotation": [180, 0, 0]}}],)" +
                test::lookAlong("[0, 0.9, 0]", "[0, 0, 0]", "[1, 0, 0]") +
                R"(, "integrator": {"type": "path_tracer", "max_bounces": 2, "enable_light_sampling": )" + sampling +
                "}}",
            {{}, 50, 1000});
        EXPECT_NEAR(rendered->mean(), 0.5 * 2.0 * formFactor, 4.5 * rendered->pixelError()) << sampling;
        EXPECT_LT(rendered->pixelError(), 0.01 * rendered->mean());
    }
}

TEST(DirectLight, EscapingRaysSeeTheLastEnvironmentOutsideMediaOnly) {
    const auto view = [](const std::string& medium) {
        return renderPaths(R"({"media": [{"name": "haze", "type": "homogeneous", "sigma_a": 1e-3},
                                                  {"name": "tint", "type": "homogeneous", "sigma_a": [1, 0, 0]}],
            "primitives": [{"type": "infinite_sphere", "emission": 5}, {"type": "infinite_sphere", "emission": [1, 2, 3]}],)" +
                               test::lookAlong("[0, 0, 0]", "[0, 0, 1]", "[0, 1, 0]", medium) +
                               R"(, "integrator": {"type": "path_tracer"}})",
                           {{}, 1, 1})
            ->film.mean(0)
            .at(0, 0);
    };
    EXPECT_EQ(view(""), Rgb(1.0f, 2.0f, 3.0f));
    EXPECT_EQ(view("haze"), Rgb(0.0f));
    EXPECT_EQ(view("tint"), Rgb(0.0f)) << "nothing comes through an endless medium, not even its clear channels";
}

} // namespace
} // namespace tungsten::path
