#pragma once
// A box of coloured fog seen through its index-matched front, with blocks that occlude and two lights whose pulses
// start at different times.

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::photon {

inline std::string boxOfFog(bool unwarped, const std::string& gate, const char* g = "0.2") {
    return std::string(
               R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": [0.1, 0.2, 0.05], "sigma_s": [0.8, 0.6, 1.0],
                          "phase_function": {"type": "henyey_greenstein", "g": )") +
           g + R"(}}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": [3, 2.2, 2.6]}},
                    {"type": "cube", "ext_medium": "fog", "bsdf": {"type": "lambert", "albedo": [0.6, 0.5, 0.4]},
                     "transform": {"position": [0.3, -0.2, 0.2], "scale": 0.6, "rotation": [10, 30, 0]}},
                    {"type": "quad", "int_medium": "fog", "ext_medium": "fog", "bsdf": {"type": "lambert", "albedo": 0.5},
                     "transform": {"position": [-0.7, 0.1, 0], "rotation": [0, 0, 90], "scale": [1, 1, 1.2]}},
                    {"type": "point", "emission": 4, "ext_medium": "fog", "transform": {"position": [-1.3, 0.95, 0.3]}},
                    {"type": "point", "emission": 2, "emission_time": 0.8, "ext_medium": "fog",
                     "transform": {"position": [1.3, -0.95, -0.6]}}],
     "camera": {"type": "pinhole", "resolution": [2, 2], "fov": 23, "reconstruction_filter": "box",
                "transform": {"position": [0.4, 0.3, 4], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "min_bounces": 0, "max_bounces": 8, "include_surfaces": false,
                    "volume_photon_count": 10000000, "gather_radius": 0.1, "volume_gather_radius": 0.02, "alpha": 1,
                    "volume_alpha": 1, "camera_unwarped": )" +
           std::string(unwarped ? "true" : "false") + ", " + gate + "}}";
}

/// The image's mean: pixels of a pass share photons, so that their errors may all go the same way.
struct Mean {
    Vec3d value{0.0}, error{0.0};
};
inline Mean meanOf(const std::string& json, const std::string& type, const char* count, uint32_t passes, int frame,
                   const char* darts = "off") {
    const auto rendered =
        test::renderPhotons(json, {{"integrator.volume_photon_type=" + type, std::string("integrator.darts=") + darts,
                                    std::string("integrator.photon_count=") + count},
                                   passes,
                                   1});
    EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
    const Image values = rendered->film.mean(frame), errors = rendered->film.standardError(frame);
    Mean mean;
    for (size_t i = 0; i < values.pixels.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            mean.value[k] += double(values.pixels[i][k]) / double(values.pixels.size());
            mean.error[k] += double(errors.pixels[i][k]) / double(values.pixels.size());
        }
    return mean;
}

} // namespace tungsten::photon
