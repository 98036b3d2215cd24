#pragma once
// Ordinary ways to the target from vertices where the walk has come by itself: connections, and the emitter met.

#include "path/GuidedPath.h"

#include "transport/Balance.h"

namespace tungsten::path {

/// From vertices in media.
struct ConnectionsFromMedia {
    /// From the ray's origin, less the share of control vertices.
    static void connect(const GuidedPath& path, const Medium& medium, const StepsToEmitter::InMedium& ending);
    /// The part of connections that is not left to emitters that plain paths meet; `pdf` is the phase function's.
    [[nodiscard]] static transport::TechniqueShare share(const GuidedPath& path, const Vec3f& position, float pdf,
                                                         const StepsToEmitter::InMedium& ending);
    /// Per length, for weights, of the walk's flights that end at `distance`.
    [[nodiscard]] static float density(const Medium& medium, float distance) {
        return transport::pdfFreeFlight(meanComponent(medium.sigmaT()), distance);
    }
};

/// From surfaces at the end of the ray.
struct ConnectionsFromSurfaces {
    /// `throughput` includes the way there.
    static void connect(const GuidedPath& path, const SurfaceHit& hit, const Rgb& throughput);
    /// The part of a connection from the surface at the end of the ray, `length` long, that is not left to light
    /// vertices and reflected light; `way` is the connection.
    [[nodiscard]] static float shareOfWalk(const GuidedPath& path, const transport::Vertex& vertex, float length,
                                           const transport::Segment& way);
    /// Per area, of the surface point at the end of the ray, `length` long, as the walk's next vertex.
    [[nodiscard]] static float density(const GuidedPath& path, const transport::Vertex& vertex, float length);
};

/// Emitters that the walk meets; not straight on from media, where it connects, and plain paths beside it meet them.
struct EmittersMet {
    /// Light that the surface at the end of the ray emits, if it is the target's; `throughput` includes the way there.
    static void add(const GuidedPath& path, const SurfaceHit& hit, const Rgb& throughput);
    /// Per solid angle at the last vertex, by its own distribution.
    [[nodiscard]] static float density(const GuidedPath& path) { return path.state.last.pdf; }
};

} // namespace tungsten::path
