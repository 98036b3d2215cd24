#pragma once
// The surfaces about a record of a volume, as its kernel meets them.

#include "photon/primitives/KernelEdge.h"

#include "tungsten/scene/Scene.h"

namespace tungsten::photon {

/// Asks for the surfaces about points.
class NearSurfaces {
  public:
    explicit NearSurfaces(const Scene& scene) : geometry_(*scene.geometry) {}

    /// The plane across the way to the nearest surface, its reach from `position`; none beyond `radius`.
    [[nodiscard]] KernelEdge nearest(const Vec3f& position, float radius) const;
    /// The surface on the other side of the nearest one, no farther than `radius`: its plane there.
    [[nodiscard]] KernelEdge opposite(const Vec3f& position, const KernelEdge& nearest, float radius) const;
    /// Whether a point can be seen from `position`; lengths are told to parts of `radius`.
    [[nodiscard]] bool sees(const Vec3f& position, const Vec3f& offset, float radius) const;

  private:
    /// Of a kernel's radius: a surface that a ray meets before is the one that its start lies on, moved by rounding.
    static constexpr float LeastLength = 1e-3f;

    const SceneGeometry& geometry_;
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
