#pragma once
// Directions at a vertex of a body that light must leave to reach its target.

#include "darts/ConnectionLobe.h"
#include "darts/FirstPassage.h"
#include "darts/ResidualRange.h"

namespace darts {

/// The lobe of the connection, and one about the drift of walks that diffuse to the boundary in time. The drift knows
/// nothing of the phase function: only where that is even does it stand in for it.
class DirectionsOut {
  public:
    /// `excess` > 0: of the connection drawn for the coming control vertex.
    DirectionsOut(const Residual& residual, float excess, const Medium& medium);

    /// Of directions at the vertex; the rest are the scatterer's own.
    [[nodiscard]] float share() const { return share_; }
    /// choice, u, v in [0, 1) -> unit direction.
    [[nodiscard]] Vec3 sample(float choice, float u, float v) const;
    /// Density per solid angle; h = 1 - cos between the direction and residual.axis.
    [[nodiscard]] float pdf(const Vec3& direction, float h) const;

  private:
    Vec3 axis_;                            ///< towards the target
    float share_, connectionShare_ = 1.0f; ///< of these directions, that of connectionLobe_
    ConnectionLobe<float> connectionLobe_, driftLobe_;
    Vec3 drift_; ///< unit axis of driftLobe_
};

} // namespace darts
