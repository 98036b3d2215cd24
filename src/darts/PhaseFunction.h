#pragma once
// Phase functions as what DirectionSampler calls a scatterer: sample(u, v) -> unit direction, pdf(direction) per solid
// angle, and exactly that density.

#include "darts/Vec3.h"

#include <optional>

namespace darts {

/// Henyey-Greenstein: the phase function that needs no table, for light that travels along `before`; g in (-1, 1) is
/// the mean cosine.
struct HenyeyGreenstein {
    Vec3 before{0, 0, 1};
    float g = 0;

    /// Per solid angle: (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^{3/2}).
    [[nodiscard]] float pdf(const Vec3& after) const { return pdfAt(oneMinusCosine(peak(), after)); }
    /// The density at h = 1 - cos to the peak.
    [[nodiscard]] float pdfAt(float h) const {
        // 1 + g^2 - 2 g cos = (1 - |g|)^2 + 2 |g| h about the peak's direction: no cancellation there.
        const float strength = std::abs(g);
        const float d = (1.0f - strength) * (1.0f - strength) + 2.0f * strength * h;
        return (1.0f - strength) * (1.0f + strength) / (4.0f * Pi * d * std::sqrt(d));
    }
    /// u, v in [0, 1) -> unit direction.
    [[nodiscard]] Vec3 sample(float u, float v) const { return directionAbout(peak(), quantile(1.0f - u), v); }

    [[nodiscard]] std::optional<HenyeyGreenstein> asHenyeyGreenstein() const { return *this; }
    /// Direction of the peak, towards which most light is scattered.
    [[nodiscard]] Vec3 peak() const { return g < 0 ? -before : before; }
    /// h = 1 - cos to the peak, within which a part f in [0, 1] of all directions lies.
    [[nodiscard]] float quantile(float f) const {
        // The inverted distribution with the difference of squares multiplied out: all terms positive.
        const float strength = std::abs(g), u = 1.0f - f, b = 1.0f - strength + 2.0f * strength * u;
        return std::min(2.0f * f * (1.0f - strength) * (1.0f - strength) * (1.0f + strength * u) / (b * b), 2.0f);
    }
    /// Its inverse: (1 + s) / (2 s) (1 - (1 - s) / sqrt((1 - s)^2 + 2 s h)), s = |g|, without a difference.
    [[nodiscard]] float part(float h) const {
        const float s = std::abs(g), root = std::sqrt((1.0f - s) * (1.0f - s) + 2.0f * s * h);
        return (1.0f + s) * h / (root * (root + 1.0f - s));
    }
};

/// A host's phase function, for light that travels along `before`: its sample(before, {u, v}) and pdf(before, after)
/// are of the host's own vectors.
template <typename Phase, typename Vector>
struct PhaseScatterer {
    const Phase& phase;
    Vector before;

    [[nodiscard]] Vec3 sample(float u, float v) const { return vec3(phase.sample(before, {u, v})); }
    [[nodiscard]] float pdf(const Vec3& after) const { return phase.pdf(before, to<Vector>(after)); }
    /// This phase function as a Henyey-Greenstein function, if it is one.
    [[nodiscard]] std::optional<HenyeyGreenstein> asHenyeyGreenstein() const {
        if (!phase.isHenyeyGreenstein()) return std::nullopt;
        return HenyeyGreenstein{vec3(before), phase.g()};
    }
};
template <typename Phase, typename Vector>
PhaseScatterer(const Phase&, const Vector&) -> PhaseScatterer<Phase, Vector>;

} // namespace darts
