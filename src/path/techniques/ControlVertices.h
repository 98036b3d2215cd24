#pragma once
// Control vertices: the last scattering before the target, in a medium, where the path arrives inside the gate.

#include "path/GuidedPath.h"

namespace tungsten::path {

struct ControlVertices {
    /// Adds the light of the one on the flight at hand, through a medium.
    static void sample(const GuidedPath& path, const transport::Ahead& ahead);
    /// Samples on a camera segment that does not count: time starts at the vertex.
    static void sampleUntimed(const GuidedPath& path, const transport::Ahead& ahead);
    /// How densely paths are found that have their last vertex in the medium at `distance` along the ray: by control
    /// vertices, and by ordinary ones.
    [[nodiscard]] static StepsToEmitter::InMedium ending(const GuidedPath& path, const Medium& medium, float distance);
    /// The same at a control vertex that is traced with this probability.
    [[nodiscard]] static StepsToEmitter::InMedium endingAt(const GuidedPath& path, const Medium& medium,
                                                           const darts::ControlVertex& vertex,
                                                           float shadowRayProbability);
};

} // namespace tungsten::path
