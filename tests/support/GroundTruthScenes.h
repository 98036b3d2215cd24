#pragma once
// Scenes with known answers, as JSON, for the tests of every integrator.

#include "support/Quadrature.h"

#include <cmath>
#include <string>

namespace tungsten::test {

/// Configuration A of the verified values: infinite medium (sigma_a 0.1, sigma_s 0.5), isotropic point of intensity 1
/// at (1.2, 0.5, 2), one camera ray along +z from the origin, order n alone (min and max bounces), gate [start, start +
/// 1).
inline std::string configurationA(int order, bool unwarped, double g = 0.0) {
    const double centre = unwarped ? 2.5 : 5.5;
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": 0.5,
                          "phase_function": {"type": "henyey_greenstein", "g": )" +
           std::to_string(g) + R"(}}],
     "primitives": [{"type": "point", "emission": 1, "ext_medium": "fog", "transform": {"position": [1.2, 0.5, 2]}}],
     "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 0.001, "medium": "fog", "reconstruction_filter": "dirac",
                "transform": {"position": [0, 0, 0], "look_at": [0, 0, 1], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "photon_count": 200000, "volume_photon_count": 2000000,
                    "fixed_volume_radius": true, "volume_gather_radius": 0.15, "alpha": 1, "volume_alpha": 1,
                    "min_bounces": )" +
           std::to_string(order) + R"(, "max_bounces": )" + std::to_string(order + 1) + R"(, "camera_unwarped": )" +
           (unwarped ? "true" : "false") + R"(, "transient_time_width": 1, "transient_time_center": )" +
           std::to_string(centre) + "}}";
}

/// Configuration C: a laser of power 1 instead of the point.
inline std::string withLaser(std::string json) {
    const std::string point =
        R"({"type": "point", "emission": 1, "ext_medium": "fog", "transform": {"position": [1.2, 0.5, 2]}})";
    return json.replace(json.find(point), point.size(), R"({"type": "collimated", "emission": 1, "ext_medium": "fog",
        "transform": {"position": [1.2, 0.5, 2], "look_at": [-0.8, 0, 3], "up": [0, 1, 0]}})");
}

/// A box of fog (sigma_a 0.05, sigma_s 0.4, speed of light 0.8) with absorbing walls, 4 wide; a point of intensity 2 at
/// (0.7, 0.6, 0.3), seen along +z from (0, 0, -1.5); single scattering in the gate [3.2, 4.2).
inline std::string foggedBox() {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.05, "sigma_s": 0.4, "speed_of_light": 0.8}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "null"}, "transform": {"scale": 4}},
                    {"type": "point", "emission": 2, "ext_medium": "fog", "transform": {"position": [0.7, 0.6, 0.3]}}],
     "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 0.001, "medium": "fog", "reconstruction_filter": "dirac",
                "transform": {"position": [0, 0, -1.5], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "photon_count": 100000, "volume_photon_count": 2000000,
                    "fixed_volume_radius": true, "volume_gather_radius": 0.1, "alpha": 1, "volume_alpha": 1,
                    "min_bounces": 1, "max_bounces": 2, "transient_time_width": 1, "transient_time_center": 3.7}})";
}

/// Its closed form: sigma_s / (4 pi) e^{-sigma_t S} I / r^2 along the ray (docs/method.md, section 8.1), over the part
/// of the ray whose time lies in the gate, by quadrature; averaged over the gate.
inline double foggedBoxSingleScattering() {
    const auto distance = [](double t) { return std::sqrt(0.7 * 0.7 + 0.6 * 0.6 + (t - 1.8) * (t - 1.8)); };
    const auto length = [&](double t) { return t + distance(t); };
    // The length grows with t: bisect for the gate's ends, v T.
    const auto inverse = [&](double target) {
        double low = 0.0, high = 3.5; // the wall
        for (int i = 0; i < 200; ++i) (length(0.5 * (low + high)) < target ? low : high) = 0.5 * (low + high);
        return low;
    };
    const auto radiance = [&](double t) {
        return 0.4 / (4.0 * 3.14159265358979323846) * std::exp(-0.45 * length(t)) * 2.0 / (distance(t) * distance(t));
    };
    return test::integrate<61>(radiance, inverse(0.8 * 3.2), inverse(0.8 * 4.2), 10, 1e-10);
}

/// A Lambert floor (albedo 0.5) at y = 0 seen straight from above through an orthographic camera at y = 2 over (0.75,
/// 0), a point of intensity 3 at (0, 1, 0) whose pulse starts at 0.6. One frame per 0.25 from time 0; no medium.
inline std::string litFloor(int frames) {
    return R"({"bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.5}],
     "primitives": [{"type": "quad", "bsdf": "grey", "transform": {"scale": [20, 1, 20]}},
                    {"type": "point", "emission": 3, "emission_time": 0.6, "transform": {"position": [0, 1, 0]}}],
     "camera": {"type": "orthographic", "orthographic_size": 0.001, "resolution": [1, 1],
                "transform": {"position": [0.75, 2, 0], "look_at": [0.75, 0, 0], "up": [1, 0, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "photon_count": 100000, "gather_radius": 0.05,
                    "gather_photon_count": 1000000, "alpha": 1, "max_bounces": 4, "start_time": 0, "transient_time_width": 0.25,
                    "frame_num": )" +
           std::to_string(frames) + "}}";
}

/// A cube of fog behind an index-matched boundary over a grey floor, lit by two points whose pulses start at different
/// times.
inline std::string fogOverFloor(const std::string& gate) {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": [0.8, 0.6, 0.4]}],
     "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.6}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"position": [0, 1, 0], "scale": 1.5}},
                    {"type": "quad", "bsdf": "grey", "transform": {"scale": [6, 1, 6]}},
                    {"type": "point", "emission": 4, "transform": {"position": [0, 3, 1]}},
                    {"type": "point", "emission": 2, "emission_time": 2, "transform": {"position": [-2, 1, 1]}}],
     "camera": {"type": "pinhole", "resolution": [16, 16], "fov": 50, "reconstruction_filter": "box",
                "transform": {"position": [0, 1.5, 5], "look_at": [0, 0.8, 0], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "max_bounces": 12, "enable_rr": false, "photon_count": 60000,
                    "volume_photon_count": 200000, "gather_radius": 0.15, "gather_photon_count": 100000, "fixed_volume_radius": true,
                    "volume_gather_radius": 0.1, "alpha": 1, "volume_alpha": 1, )" +
           gate + "}}";
}
inline const char* const SteadyState = R"("transient_time_width": 0, "transient_time_center": -1)";

/// A sphere in a uniform environment of radiance 1: a Lambert one of albedo 0.3, or a non-absorbing cloud.
inline std::string furnace(bool cloud) {
    const std::string sphere = cloud ? R"({"type": "sphere", "int_medium": "cloud", "bsdf": {"type": "forward"}})"
                                     : R"({"type": "sphere", "bsdf": {"type": "lambert", "albedo": 0.3}})";
    return R"({"media": [{"name": "cloud", "type": "homogeneous", "sigma_s": 2}], "primitives": [)" + sphere +
           R"(, {"type": "infinite_sphere", "emission": 1}],
     "camera": {"type": "pinhole", "resolution": [4, 4], "fov": 8, "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
     "integrator": {"type": "path_tracer", "max_bounces": 1000}})";
}

} // namespace tungsten::test
