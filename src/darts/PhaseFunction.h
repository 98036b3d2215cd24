#pragma once
// Henyey-Greenstein: the phase function that needs no table. Hosts bring their own by the same two members.

#include "darts/Vec3.h"

namespace darts {

/// Scattering of light that travels along `before`; g in (-1, 1) is the mean cosine. Models what DirectionSampler calls
/// a scatterer: sample(u, v) -> unit direction, pdf(direction) per solid angle, and exactly that density.
struct HenyeyGreenstein {
    Vec3 before{0, 0, 1};
    float g = 0;

    [[nodiscard]] float pdf(const Vec3& after) const {
        // 1 + g^2 - 2 g cos = (1 - |g|)^2 + 2 |g| h about the peak's direction: no cancellation there.
        const float strength = std::abs(g), h = oneMinusCosine(g < 0 ? -before : before, after);
        const float d = (1.0f - strength) * (1.0f - strength) + 2.0f * strength * h;
        return (1.0f - g * g) / (4.0f * Pi * d * std::sqrt(d));
    }
    [[nodiscard]] Vec3 sample(float u, float v) const {
        // h of the inverted distribution, with the difference of squares multiplied out.
        const float b = 1.0f - g + 2.0f * g * u;
        const float h = 2.0f * (1.0f - u) * (1.0f - g) * (1.0f - g) * (1.0f + g * u) / (b * b);
        return directionAbout(before, std::clamp(h, 0.0f, 2.0f), v);
    }
};

} // namespace darts
