#pragma once
// An emitter's own distribution of directions, as a scatterer of the sampling library.

#include "darts/Vec3.h"

#include "tungsten/emitter/Emitter.h"

namespace tungsten::photon {

/// Uniform over what the emitter lights: the sphere of a point, the cone of a spot; cosine-weighted for surfaces, in
/// the cone of a disk.
class EmissionDirections {
  public:
    EmissionDirections(const Emitter& emitter, const SurfaceSample& start) {
        if (const auto* spot = std::get_if<SpotEmitter>(&emitter.model)) {
            axis_ = darts::vec3(spot->direction);
            widest_ = 1.0f - spot->cosOuter;
        } else if (const auto* area = std::get_if<AreaEmitter>(&emitter.model)) {
            axis_ = darts::vec3(start.normal);
            widest_ = 1.0f - area->cosCone();
            cosine_ = true;
        }
    }
    [[nodiscard]] darts::Vec3 sample(float u, float v) const {
        // sin^2 is uniform for the cosine: with x for it, h = 1 - sqrt(1 - x) = x / (1 + sqrt(1 - x)).
        const float x = u * sineSquared();
        return darts::directionAbout(axis_, cosine_ ? x / (1.0f + std::sqrt(1.0f - x)) : widest_ * u, v);
    }
    /// Above 0 for whatever sample() draws.
    [[nodiscard]] float pdf(const darts::Vec3& direction) const {
        const float h = darts::oneMinusCosine(direction, axis_);
        // Rounding carries directions across the cone's edge, by as much as it moves their difference from the axis.
        // Beyond it nothing is emitted, so that the density there does not matter.
        if (h > widest_ + Rounding * std::sqrt(widest_)) return 0.0f;
        return cosine_ ? std::max(1.0f - h, LeastCosine) / (darts::Pi * sineSquared())
                       : 1.0f / (2.0f * darts::Pi * widest_);
    }

  private:
    static constexpr float Rounding = 1e-6f, LeastCosine = 1e-6f;

    /// Of the cone's half angle.
    [[nodiscard]] float sineSquared() const { return widest_ * (2.0f - widest_); }

    darts::Vec3 axis_{0, 0, 1};
    float widest_ = 2.0f; ///< largest 1 - cos
    bool cosine_ = false;
};

} // namespace tungsten::photon
