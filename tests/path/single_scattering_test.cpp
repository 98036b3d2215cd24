// Single scattering of a point pulse in a cube of fog, frame by frame, against the closed form
//   L(t) = sigma_s f_p exp(-sigma_t (s + r)) I / r^2 along the camera ray, s from its entry, r from there to the light.

#include "path/look_along.h"
#include "support/PathsAndPhotons.h"
#include "support/Quadrature.h"

#include <boost/math/tools/roots.hpp>
#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

constexpr double SigmaA = 0.2, G = 0.4, Intensity = 2.0, FogSpeed = 0.5;
constexpr double SigmaS[3] = {0.8, 0.5, 0.3};
constexpr double Entry = 4.0, Chord = 2.0; ///< the ray meets the cube [-1, 1]^3 at z = 1 after 4, leaves at z = -1
constexpr int Frames = 8;

/// Where the light is, and how time passes.
struct Case {
    const char* name;
    Vec3d light;
    bool unwarped;
    int interactions; ///< entry, scattering, and the boundary toward a light outside
    double start, width;
};

/// The connection from depth s on the ray (0.1, 0.2, 1 - s) to the light.
struct Connection {
    double inside, outside, cosine;

    Connection(const Case& c, double s) {
        const Vec3d offset = c.light - Vec3d(0.1, 0.2, 1.0 - s);
        const double length = offset.length();
        const double beyond = std::max(c.light.z - 1.0, 0.0) / offset.z; // share of the way outside the front face
        outside = c.light.z > 1.0 ? length * beyond : 0.0;
        inside = length - outside;
        cosine = -offset.z / length; // between the camera ray (0, 0, -1) and the direction to the light
    }
    [[nodiscard]] double length() const { return inside + outside; }
};

double arrival(const Case& c, double s) {
    const Connection connection(c, s);
    const double fromLight = connection.inside / FogSpeed + connection.outside;
    return fromLight + (c.unwarped ? 0.0 : Entry + s / FogSpeed);
}

double radiancePerDepth(const Case& c, int channel, double s) {
    const Connection connection(c, s);
    const double phase = (1.0 - G * G) / (4.0 * M_PI * std::pow(1.0 + G * G - 2.0 * G * connection.cosine, 1.5));
    const double sigmaT = SigmaA + SigmaS[channel];
    return SigmaS[channel] * phase * std::exp(-sigmaT * (s + connection.inside)) * Intensity /
           (connection.length() * connection.length());
}

/// Depth in [low, high], where the arrival time is monotonic, at which it is `time` (clamped to the ends).
double depthAt(const Case& c, double low, double high, double time) {
    const auto f = [&](double s) { return arrival(c, s) - time; };
    if (f(low) * f(high) > 0.0) return (std::abs(f(low)) < std::abs(f(high))) ? low : high;
    const auto bracket = boost::math::tools::bisect(f, low, high, boost::math::tools::eps_tolerance<double>(45));
    return 0.5 * (bracket.first + bracket.second);
}

double expectedRadiance(const Case& c, int channel, int frame) {
    const double from = c.start + frame * c.width, to = from + c.width;
    // The distance to the light falls until the ray passes it, then rises.
    const double nearest = std::clamp(1.0 - c.light.z, 0.0, Chord);
    double sum = 0.0;
    for (const auto& [low, high] : {std::pair(0.0, nearest), std::pair(nearest, Chord)}) {
        if (low >= high) continue;
        const double a = depthAt(c, low, high, from), b = depthAt(c, low, high, to);
        sum += std::abs(test::integrate<31>([&](double s) { return radiancePerDepth(c, channel, s); }, a, b, 10, 1e-9));
    }
    return sum / c.width;
}

std::string scene(const Case& c) {
    const auto number = [](double x) { return std::to_string(x); };
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.2, "sigma_s": [0.8, 0.5, 0.3],
                "speed_of_light": 0.5, "phase_function": {"type": "henyey_greenstein", "g": 0.4}}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 2}},
                    {"type": "point", "emission": 2, "transform": {"position": [)" +
           number(c.light.x) + "," + number(c.light.y) + "," + number(c.light.z) + "]}}]," +
           test::lookAlong("[0.1, 0.2, 5]", "[0.1, 0.2, 0]", "[0, 1, 0]") +
           R"(, "integrator": {"type": "path_tracer", "min_bounces": )" + std::to_string(c.interactions) +
           R"(, "max_bounces": )" + std::to_string(c.interactions + 1) + R"(, "camera_unwarped": )" +
           (c.unwarped ? "true" : "false") + R"(, "start_time": )" + number(c.start) + R"(, "transient_time_width": )" +
           number(c.width) + R"(, "frame_num": )" + std::to_string(Frames) + "}}";
}

class SingleScattering : public testing::TestWithParam<std::tuple<Case, const char*>> {};

TEST_P(SingleScattering, MatchesTheClosedFormInEveryFrame) {
    const auto& [c, sampling] = GetParam();
    const auto rendered = test::renderPaths(scene(c), {{std::string("integrator.darts=") + sampling}, 100, 1500});
    double total = 0.0;
    for (int frame = 0; frame < Frames; ++frame) {
        const Rgb mean = rendered->film.mean(frame).at(0, 0), error = rendered->film.standardError(frame).at(0, 0);
        for (int channel = 0; channel < 3; ++channel) {
            const double expected = expectedRadiance(c, channel, frame);
            EXPECT_NEAR(double(mean[channel]), expected, 4.5 * double(error[channel]) + 1e-9)
                << "frame " << frame << " channel " << channel;
            EXPECT_LE(double(error[channel]), 0.05 * expected + 1e-4) << "too noisy to see a wrong value";
            total += expected;
        }
    }
    EXPECT_GT(total, 5e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, SingleScattering,
    testing::Combine(testing::Values(Case{"LightInside", {0.5, 0.6, -0.2}, false, 2, 6.5, 0.5},
                                     Case{"LightInsideUnwarped", {0.5, 0.6, -0.2}, true, 2, 0.9, 0.25},
                                     Case{"LightOutside", {0.3, 0.4, 3.0}, false, 3, 5.5, 1.0}),
                     testing::Values("off", "published", "best")),
    [](const auto& instance) {
        return std::string(std::get<0>(instance.param).name) + "_" + std::get<1>(instance.param);
    });

} // namespace
} // namespace tungsten::path
