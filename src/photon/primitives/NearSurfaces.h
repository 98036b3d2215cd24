#pragma once
// The surfaces about a record of a volume, as its kernel meets them.

#include "photon/primitives/Selection.h"
#include "photon/primitives/SurfaceCells.h"
#include "photon/raster/ImageFootprint.h"

#include "tungsten/core/Random.h"
#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/scene/Scene.h"

namespace tungsten::photon {

/// Asks for the surfaces about points.
class NearSurfaces {
  public:
    /// `radius`: of kernels, Infinity where it differs from pass to pass; `reachInRadii`: how far surfaces are asked
    /// for.
    NearSurfaces(const Scene& scene, float radius, float reachInRadii);

    struct Nearest {
        KernelEdge edge;
        bool alone = false; ///< no surface within the radius lies elsewhere than in the edge's plane
        bool faced = true;  ///< another may lie within the radius on the other side
    };
    /// The plane across the way to the nearest surface, its reach from `position`; none beyond `radius`.
    [[nodiscard]] Nearest nearest(const Vec3f& position, float radius) const;
    /// No surface is nearer to the point; often less than the distance of the nearest.
    [[nodiscard]] float clearance(const Vec3f& position) const { return cells_.distance(position).least; }
    /// The surface on the other side of the nearest one, no farther than `radius`: its plane there.
    [[nodiscard]] KernelEdge opposite(const Vec3f& position, const KernelEdge& nearest, float radius) const;
    /// Whether a point can be seen from `position`; lengths are told to parts of `radius`.
    [[nodiscard]] bool sees(const Vec3f& position, const Vec3f& offset, float radius) const;

  private:
    /// Least length, relative to a kernel's radius: a surface that a ray meets before is the one that its start lies
    /// on, moved by rounding.
    static constexpr float LeastLength = 1e-3f;

    NearSurfaces(const SceneGeometry& geometry, float size, float radius, float reachInRadii);

    [[nodiscard]] Nearest nearestOf(const SurfaceCells::Faces& faces, const Vec3f& position, float radius) const;

    const SceneGeometry& geometry_;
    SurfaceCells cells_;
};

/// For what primitives do about a pass's kernels at surfaces.
struct KernelEnds {
    const Scene& scene;
    const NearSurfaces& surfaces;
    Sampler random;                          ///< of the pass
    std::optional<ImageFootprint> view = {}; ///< where only straight rays of the image look; none: any ray may
    ProgressToken watch = {};
};

/// How many points of a kernel are tried until one can be seen from its record: on average, and without bias, one over
/// the part of them. Of points that can hardly be seen it is bounded.
template <typename Try>
int triesUntilSeen(Try&& seen) {
    constexpr int Most = 64;
    int count = 1;
    while (count < Most && !seen()) ++count;
    return count;
}

} // namespace tungsten::photon
