#pragma once
// Phase functions as what DirectionSampler calls a scatterer: sample(u, v) -> unit direction, pdf(direction) per solid
// angle, and exactly that density.

#include "darts/Vec3.h"

namespace darts {

/// A host's phase function, for light that travels along `before`: its sample(before, {u, v}) and pdf(before, after)
/// are of the host's own vectors.
template <typename Phase, typename Vector>
struct PhaseScatterer {
    const Phase& phase;
    Vector before;

    [[nodiscard]] Vec3 sample(float u, float v) const { return vec3(phase.sample(before, {u, v})); }
    [[nodiscard]] float pdf(const Vec3& after) const { return phase.pdf(before, to<Vector>(after)); }
};
template <typename Phase, typename Vector>
PhaseScatterer(const Phase&, const Vector&) -> PhaseScatterer<Phase, Vector>;

/// Henyey-Greenstein: the phase function that needs no table, for light that travels along `before`; g in (-1, 1) is
/// the mean cosine.
struct HenyeyGreenstein {
    Vec3 before{0, 0, 1};
    float g = 0;

    /// Per solid angle: (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^{3/2}).
    [[nodiscard]] float pdf(const Vec3& after) const {
        // 1 + g^2 - 2 g cos = (1 - |g|)^2 + 2 |g| h about the peak's direction: no cancellation there.
        const float strength = std::abs(g), h = oneMinusCosine(peak(), after);
        const float d = (1.0f - strength) * (1.0f - strength) + 2.0f * strength * h;
        return (1.0f - strength) * (1.0f + strength) / (4.0f * Pi * d * std::sqrt(d));
    }
    /// u, v in [0, 1) -> unit direction.
    [[nodiscard]] Vec3 sample(float u, float v) const {
        // h of the inverted distribution about the peak, with the difference of squares multiplied out: all terms
        // positive.
        const float strength = std::abs(g), b = 1.0f - strength + 2.0f * strength * u;
        const float h = 2.0f * (1.0f - u) * (1.0f - strength) * (1.0f - strength) * (1.0f + strength * u) / (b * b);
        return directionAbout(peak(), std::min(h, 2.0f), v);
    }

  private:
    [[nodiscard]] Vec3 peak() const { return g < 0 ? -before : before; }
};

} // namespace darts
