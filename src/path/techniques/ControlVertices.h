#pragma once
// Control vertices: the last scattering before the target, in a medium, where the path arrives inside the gate.

#include "path/GuidedPath.h"

namespace tungsten::path {

struct ControlVertices {
    /// Adds the light of the one on the flight at hand, through a medium.
    static void sample(const GuidedPath& path, const transport::Ahead& ahead);
    /// The same on a camera segment that does not count: time starts at the vertex.
    static void sampleUntimed(const GuidedPath& path, const transport::Ahead& ahead);
    /// Per length along the ray at `distance`. None where no other technique finds paths with a last vertex there that
    /// this one does.
    [[nodiscard]] static std::optional<float> density(const GuidedPath& path, float distance) {
        return path.steps.controlVertexPdf(distance);
    }
    /// The part of a path with a vertex in the medium at `distance` along the ray that is left to control vertices.
    [[nodiscard]] static float share(const GuidedPath& path, const Medium& medium, float distance);
};

} // namespace tungsten::path
