#pragma once
// How near to a surface rays may start and end without meeting it by mistake.

#include "tungsten/core/Types.h"

namespace tungsten {

struct TriangleMesh;

/// Of a point on a surface. Rounding puts the point beside the surface that rays meet, and that surface beside the true
/// one: by `error` at most, along the normal. It depends on the point and its face alone, not on the rest of the scene.
struct SurfaceMargin {
    Vec3f normal{0.0f};
    float error = 0.0f; ///< 0: a point in space, which needs no margin
    FaceIndex face{};   ///< what the point lies on, where that is part of a scene

    [[nodiscard]] bool onSurface() const { return error > 0.0f; }
    /// The length after which a ray that met, or left, the surface after `distance` is clear of it.
    [[nodiscard]] float beyond(const Vec3f& direction, float distance = 0.0f) const {
        return onSurface() ? distance + along(direction, distance) : distance;
    }
    /// The length up to which a ray that will meet the surface after `distance` has not done so.
    [[nodiscard]] float before(const Vec3f& direction, float distance) const {
        return onSurface() ? distance - along(direction, distance) : distance;
    }
    /// `position`, a point of the surface, moved off it to the side of `direction`. A ray from there needs no margin
    /// along itself: on grazing directions that is long, and skips the walls that meet the surface nearby.
    [[nodiscard]] Vec3f off(const Vec3f& position, const Vec3f& direction) const {
        constexpr float Errors = 2.0f; // the sum's rounding takes up to half of one
        return position + normal * std::copysign(Errors * error, direction.dot(normal));
    }

    /// A ray from `position`, a point of the surface, that does not meet the surface there.
    [[nodiscard]] Ray spawnRay(const Vec3f& position, const Vec3f& direction) const {
        return {position, direction, beyond(direction), Infinity, face};
    }

  private:
    [[nodiscard]] float along(const Vec3f& direction, float distance) const {
        // Of unit directions, and of ray tests from afar.
        constexpr float DirectionError = 16.0f * std::numeric_limits<float>::epsilon();
        constexpr float LeastCosine = 1e-4f;
        return (error + DirectionError * distance) / std::max(std::abs(direction.dot(normal)), LeastCosine);
    }
};

/// Error of a margin for a point whose coordinates are those of its surface, rounded.
float roundingError(const Vec3f& position, const Vec3f& normal);
/// The same for a point of a triangle at the barycentric weights `b1`, `b2` of its second and third corner.
float roundingError(const TriangleMesh& mesh, uint32_t triangle, float b1, float b2, const Vec3f& position,
                    const Vec3f& normal);

} // namespace tungsten
