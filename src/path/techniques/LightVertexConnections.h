#pragma once
// Light by way of surface points that it reaches first (LightVertices.h), connected to vertices of the walk.

#include "path/GuidedPath.h"
#include "path/techniques/LightVertices.h"

namespace tungsten::path {

struct LightVertexConnections {
    /// From the vertex at the ray's origin.
    static void connect(const GuidedPath& path, const transport::Vertex& here, const LightVertexCache& cache);
    /// Per area, of a surface point that light reaches with density `areaPdf`.
    [[nodiscard]] static float density(float areaPdf) { return candidateDensity(areaPdf); }
};

} // namespace tungsten::path
