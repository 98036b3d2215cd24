#pragma once
// Light that a glossy surface has reflected (GlossyLightVertices.h), connected to vertices of the walk.

#include "path/GuidedPath.h"
#include "path/techniques/GlossyLightVertices.h"

namespace tungsten::path {

struct GlossyVertexConnections {
    /// From the vertex at the ray's origin.
    static void connect(const GuidedPath& path, const transport::Vertex& here, const GlossyVertexCache& cache);
    /// Whether one vertex before reflected light was connected to that may have come by way of `glossy`.
    [[nodiscard]] static bool mayFind(const GuidedPath& path, const transport::Vertex& glossy) {
        return path.behind.approach && reflectsSharply(glossy.lobes());
    }
    /// Density of the reflected light that one vertex before was connected to (mayFind), at the ray's origin and at a
    /// light vertex of density `areaPdf` at the end of `way`, over the walk's density at the ray's origin. `pdf` is
    /// light's from there, per solid angle, back along `way`.
    [[nodiscard]] static float density(const GuidedPath& path, float pdf, const transport::Segment& way, float areaPdf);
};

} // namespace tungsten::path
