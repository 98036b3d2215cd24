// Light that reaches visible surfaces straight from the lights, against quadrature over the pixels.

#include "render_photons.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using test::renderPhotons;

constexpr double Absorption = 0.1, Albedo = 0.6, Intensity = 3.0, Start = 6.0, Width = 0.25;
constexpr int Frames = 6;

/// A point over a floor in a medium that hardly scatters.
const char* const LitFloor = R"({"media": [{"name": "haze", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": 1e-6}],
     "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.6}],
     "primitives": [{"type": "quad", "bsdf": "grey", "transform": {"scale": [40, 1, 40]}},
                    {"type": "point", "emission": 3, "ext_medium": "haze", "transform": {"position": [0.5, 1.5, 0]}}],
     "camera": {"type": "pinhole", "resolution": [16, 16], "fov": 40, "medium": "haze", "reconstruction_filter": "box",
                "transform": {"position": [0, 3, 4], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "max_bounces": 2, "enable_rr": false,
                    "photon_count": 2000, "volume_photon_count": 100, "gather_radius": 0.05, "fixed_volume_radius": true,
                    "gather_photon_count": 100000, "start_time": 6, "transient_time_width": 0.25, "frame_num": 6,
                    "darts": "best"}})";

/// Radiance of one pixel, averaged over a frame.
double litPixel(const Camera& camera, int x, int y, int frame) {
    constexpr int Side = 48;
    const Vec3d light(0.5, 1.5, 0.0);
    double sum = 0.0;
    for (int i = 0; i < Side * Side; ++i) {
        const Vec2f u((float(i % Side) + 0.5f) / Side, (float(i / Side) + 0.5f) / Side);
        const Ray ray = camera.generateRay({x, y}, u, Vec2f(0.5f));
        if (!(ray.direction.y < 0.0f)) continue;
        const double t = -double(ray.origin.y) / double(ray.direction.y);
        const Vec3d way = light - Vec3d(double(ray.origin.x) + t * double(ray.direction.x), 0.0,
                                        double(ray.origin.z) + t * double(ray.direction.z));
        const double d = way.length(), arrival = t + d;
        if (arrival < Start + frame * Width || arrival >= Start + (frame + 1) * Width) continue;
        sum += Albedo / double(Pi) * Intensity * (way.y / d) / (d * d) * std::exp(-Absorption * arrival) / Width;
    }
    return sum / (Side * Side);
}

TEST(DirectLight, IsThatOfQuadratureInEveryPixelAndFrame) {
    const auto image = renderPhotons(LitFloor, {{}, 48, 1});
    for (int frame = 0; frame < Frames; ++frame) {
        SCOPED_TRACE(frame);
        const Image mean = image->film.mean(frame), error = image->film.standardError(frame);
        double expected = 0.0, found = 0.0, variance = 0.0, squares = 0.0;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                const double value = litPixel(image->scene->camera, x, y, frame);
                expected += value;
                found += double(mean.at(x, y).y);
                variance += double(error.at(x, y).y) * double(error.at(x, y).y);
                squares += (double(mean.at(x, y).y) - value) * (double(mean.at(x, y).y) - value);
            }
        ASSERT_GT(expected, 0.0);
        EXPECT_NEAR(found, expected, 4.5 * std::sqrt(variance) + 0.002 * expected);
        EXPECT_LT(std::sqrt(variance), 0.01 * expected) << "the test would not see a wrong value";
        // Nothing is blurred: pixels differ by their own noise alone.
        EXPECT_LT(squares, 2.0 * variance);
    }
}

TEST(DirectLight, IsOfOrderOne) {
    const auto image = renderPhotons(LitFloor, {{"integrator.min_bounces=2", "integrator.max_bounces=3"}, 4, 1});
    for (int frame = 0; frame < Frames; ++frame) EXPECT_LT(image->mean(frame), 1e-4);
}

} // namespace
} // namespace tungsten::photon
