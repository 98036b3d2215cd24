#pragma once
// Directions at a vertex of a body that light must leave to reach its target.

#include "darts/ConnectionLobe.h"
#include "darts/FirstPassage.h"
#include "darts/ResidualRange.h"

namespace darts {

/// A lobe about the drift of walks that diffuse to the boundary in time, and the lobe of the connection. Holds the
/// residual and the medium by reference.
class DirectionsOut {
  public:
    /// `excess` > 0: of the connection drawn for the coming control vertex.
    DirectionsOut(const Residual& residual, float excess, const Medium& medium);

    /// choice, u, v in [0, 1) -> unit direction.
    [[nodiscard]] Vec3 sample(float choice, float u, float v) const;
    /// Density per solid angle; h = 1 - cos between the direction and residual.axis.
    [[nodiscard]] float pdf(const Vec3& direction, float h) const;
    /// What a direction is good for, about 1 on the average: the first passage from where light gets to, and the
    /// connection, whose last turn has the density `last` per solid angle.
    [[nodiscard]] float usefulness(const Heading& ray, float pdf, float last) const;

  private:
    [[nodiscard]] float connectionUsefulness(const Heading& ray, float last) const;

    const Residual& residual_;
    const Medium& medium_;
    float excess_, sigmaT_;
    float here_; ///< logarithm of the first passage from the vertex
    float gate_; ///< length of the gate in mean free paths
    float connectionShare_ = 0;
    ConnectionLobe<float> connectionLobe_, driftLobe_;
    Vec3 drift_; ///< unit axis of driftLobe_
};

} // namespace darts
