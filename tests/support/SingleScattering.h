#pragma once
// Single scattering of point pulses in an infinite medium: the closed form, and the scene it is the answer to.

#include "support/Agreement.h"

#include <boost/math/quadrature/gauss.hpp>

#include <array>
#include <sstream>

namespace tungsten::test {

struct Pulse {
    Vec3d position, intensity;
    double emissionTime;
};

/// Where fog begins, and how wide the square image is.
inline constexpr double FogDepth = 2.5, FieldOfView = 40.0;

/// Pulses in a half space of Henyey-Greenstein fog, z > FogDepth behind an index-matched boundary, seen from the origin
/// in vacuum (speed of light 1) along +z, in one gate. (A camera in the fog would have photons right before its lens.)
struct PulsesInFog {
    std::string name;
    Vec3d sigmaA, sigmaS;
    double g, speed;
    std::vector<Pulse> pulses;
    double gateStart, gateWidth;
};

/// Light fronts that cross the image while the gate is open: what it sees changes with the speeds.
inline std::vector<PulsesInFog> singleScatteringCases() {
    const Pulse aside{{1.8, 0.4, 3.6}, Vec3d(1.0), 0.0}; // out of view
    const Pulse red{{1.8, 0.4, 3.6}, {1.0, 0.5, 0.2}, 0.0}, blue{{-1.7, -0.5, 3.7}, {0.2, 0.5, 1.0}, 0.4};
    return {
        {"forward", Vec3d(0.1), Vec3d(0.5), 0.7, 1.0, {aside}, 4.65, 0.15},
        {"backward", Vec3d(0.1), Vec3d(0.5), -0.4, 1.0, {aside}, 4.65, 0.15},
        {"coloured and slow", {0.3, 0.15, 0.08}, {0.25, 0.5, 1.0}, 0.2, 0.75, {aside}, 5.3, 0.2},
        {"two pulses", Vec3d(0.05), Vec3d(0.4), 0.0, 1.0, {red, blue}, 4.85, 0.15},
    };
}
inline constexpr Effort ClosedFormEffort{32, 64, 48, 60000};

inline std::string toJson(const Vec3d& v) {
    std::ostringstream text;
    text << '[' << v.x << ", " << v.y << ", " << v.z << ']';
    return text.str();
}

inline std::string sceneJson(const PulsesInFog& c) {
    std::ostringstream json;
    json << R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": )" << toJson(c.sigmaA) << R"(, "sigma_s": )"
         << toJson(c.sigmaS) << R"(, "speed_of_light": )" << c.speed
         << R"(, "phase_function": {"type": "henyey_greenstein", "g": )" << c.g << R"(}}],
             "primitives": [{"type": "quad", "int_medium": "fog", "bsdf": {"type": "forward"},
                             "transform": {"rotation": [-90, 0, 0], "scale": 1000, "position": [0, 0, )"
         << FogDepth << "]}}";
    for (size_t i = 0; i < c.pulses.size(); ++i)
        json << R"(, {"type": "point", "ext_medium": "fog", "emission": )" << toJson(c.pulses[i].intensity)
             << R"(, "emission_time": )" << c.pulses[i].emissionTime << R"(, "transform": {"position": )"
             << toJson(c.pulses[i].position) << "}}";
    json << R"(], "camera": {"type": "pinhole", "fov": )" << FieldOfView << R"(, "reconstruction_filter": "box",
             "transform": {"position": [0, 0, 0], "look_at": [0, 0, 1], "up": [0, 1, 0]}},
             "integrator": {"min_bounces": 2, "max_bounces": 3, "transient_time_center": )"
         << c.gateStart + 0.5 * c.gateWidth << R"(, "transient_time_width": )" << c.gateWidth << "}}";
    return json.str();
}

/// Radiance along the unit direction `ray` from the origin, averaged over the gate: with t to the scattering point, e
/// to the fog and r to the pulse, the integral over t > e of sigma_s f_p e^{-sigma_t (t - e + r)} I / r^2 where e + (t
/// - e + r) / v plus the emission time lies in the gate (docs/method.md, section 8.1).
inline Vec3d singleScattering(const PulsesInFog& c, const Vec3d& ray) {
    Vec3d sum(0.0);
    const double entry = FogDepth / ray.z;
    for (const Pulse& pulse : c.pulses) {
        const double squared = pulse.position.dot(pulse.position), along = pulse.position.dot(ray);
        // t + r = S at t = (S^2 - C^2) / (2 (S - C cos)); t + r grows with t from C on.
        const auto depth = [&](double time) {
            const double length = entry + c.speed * (time - pulse.emissionTime - entry);
            return length * length <= squared ? entry
                                              : std::max((length * length - squared) / (2.0 * (length - along)), entry);
        };
        const double from = depth(c.gateStart), to = depth(c.gateStart + c.gateWidth);
        if (from >= to) continue;
        using Quadrature = boost::math::quadrature::gauss<double, 15>;
        for (int channel = 0; channel < 3; ++channel)
            sum[channel] += Quadrature::integrate(
                [&](double t) {
                    const Vec3d toPulse = pulse.position - ray * t;
                    const double r = toPulse.length();
                    // Light travels from the pulse and leaves toward the camera, against the ray.
                    const double cosine = toPulse.dot(ray) / r;
                    const double phase =
                        (1.0 - c.g * c.g) / (4.0 * M_PI * std::pow(1.0 + c.g * c.g - 2.0 * c.g * cosine, 1.5));
                    const double sigmaT = c.sigmaA[channel] + c.sigmaS[channel];
                    return c.sigmaS[channel] * phase * std::exp(-sigmaT * (t - entry + r)) * pulse.intensity[channel] /
                           (r * r);
                },
                from, to);
    }
    return sum / c.gateWidth;
}

/// Exact block means of a side x side image: the midpoint rule over 4 x 4 rays per pixel.
inline BlockMeans closedForm(const PulsesInFog& c, int side) {
    constexpr int PerPixel = 4;
    const double distance = 1.0 / std::tan(0.5 * FieldOfView * M_PI / 180.0);
    const int fine = side * PerPixel, columns = side / BlockSide;
    BlockMeans result(1, blockCount(side, side));
    for (int y = 0; y < fine; ++y)
        for (int x = 0; x < fine; ++x) {
            // The image's right is -x for a camera that looks along +z with y up.
            const Vec3d ray(1.0 - 2.0 * (x + 0.5) / fine, 1.0 - 2.0 * (y + 0.5) / fine, distance);
            const Vec3d radiance = singleScattering(c, ray / ray.length());
            const int block = (y / PerPixel / BlockSide) * columns + x / PerPixel / BlockSide;
            result.mean[size_t(block)] += radiance / double(PerPixel * PerPixel * BlockSide * BlockSide);
            result.mean.back() += radiance / double(fine * fine);
        }
    return result;
}

} // namespace tungsten::test
