#pragma once
// An emitter's own distribution of directions, as a scatterer of the sampling library.

#include "photon/Tuning.h"

#include "darts/Vec3.h"

#include "transport/BoundedMedium.h"

#include "tungsten/emitter/Emitter.h"

#include <span>
#include <vector>

namespace tungsten::photon {

/// The emitter's cone of directions, of one that shines in more than a single direction. A share goes towards bodies of
/// fog that are small from there, each as much as the other.
class EmissionDirections {
  public:
    EmissionDirections(const Emitter& emitter, const SurfaceSample& start,
                       std::span<const transport::MediumSphere> bodies = {}) {
        const EmissionCone cone = emissionCone(emitter, start);
        axis_ = darts::vec3(cone.axis);
        widest_ = cone.widest;
        cosine_ = cone.cosineWeighted;
        for (const transport::MediumSphere& body : bodies) addCone(start.position, body);
        if (!cones_.empty()) share_ = tuning::TowardsBodies;
    }
    [[nodiscard]] darts::Vec3 sample(float u, float v) const {
        if (u < share_) {
            const float scaled = u / share_ * float(cones_.size());
            const size_t chosen = std::min(size_t(scaled), cones_.size() - 1);
            return darts::directionAbout(cones_[chosen].axis, (scaled - float(chosen)) * cones_[chosen].widest, v);
        }
        const float rest = (u - share_) / (1.0f - share_);
        // sin^2 is uniform for the cosine: with x for it, h = 1 - sqrt(1 - x) = x / (1 + sqrt(1 - x)).
        const float x = rest * sineSquared();
        return darts::directionAbout(axis_, cosine_ ? x / (1.0f + std::sqrt(1.0f - x)) : widest_ * rest, v);
    }
    /// Above 0 for whatever sample() draws.
    [[nodiscard]] float pdf(const darts::Vec3& direction) const {
        const float h = darts::oneMinusCosine(direction, axis_);
        float own = uniform(h, widest_);
        if (cosine_ && own > 0.0f) own = std::max(1.0f - h, LeastCosine) / (darts::Pi * sineSquared());
        if (cones_.empty()) return own;
        float towards = 0.0f;
        for (const Cone& cone : cones_) towards += uniform(darts::oneMinusCosine(direction, cone.axis), cone.widest);
        return (1.0f - share_) * own + share_ * towards / float(cones_.size());
    }

  private:
    static constexpr float Rounding = 1e-6f, LeastCosine = 1e-6f;

    struct Cone {
        darts::Vec3 axis;
        float widest; ///< largest 1 - cos
    };

    /// Squared sine of the cone's half angle.
    [[nodiscard]] float sineSquared() const { return widest_ * (2.0f - widest_); }
    /// Rounding carries directions across a cone's edge, by as much as it moves their difference from the axis. Beyond
    /// the emitter's own edge nothing is emitted, so that the density there does not matter.
    [[nodiscard]] static float uniform(float h, float widest) {
        const float edge = widest + Rounding * std::sqrt(widest);
        return h <= edge ? 1.0f / (2.0f * darts::Pi * widest) : 0.0f;
    }
    void addCone(const Vec3f& position, const transport::MediumSphere& body) {
        const Vec3f offset = body.centre - position;
        const float distance = offset.length();
        if (!(distance > body.radius)) return;
        const darts::Vec3 axis = darts::vec3(offset / distance);
        const float sine = body.radius / distance, widest = sine * sine / (1.0f + std::sqrt(1.0f - sine * sine));
        // Half of what the emitter lights, or more, needs no help.
        if (widest > 0.5f * widest_) return;
        const auto angle = [](float h) { return std::acos(std::clamp(1.0f - h, -1.0f, 1.0f)); };
        if (angle(darts::oneMinusCosine(axis, axis_)) < angle(widest_) + angle(widest))
            cones_.push_back({axis, widest});
    }

    darts::Vec3 axis_;
    float widest_; ///< largest 1 - cos
    bool cosine_;
    std::vector<Cone> cones_;
    float share_ = 0.0f;
};

} // namespace tungsten::photon
