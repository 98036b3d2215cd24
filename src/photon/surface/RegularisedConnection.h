#pragma once
// Light that arrives at a visible point from close by, spread over the surface about the point.

#include "tungsten/core/Types.h"

namespace tungsten::photon {

/// A flight from a vertex as a visible point sees it.
struct RegularisedConnection {
    Vec3f from;   ///< unit direction towards the vertex, where it is seen
    float weight; ///< instead of 1 / squared distance; at most 1 / spread^2

    /// What arrives, to be reflected as coming along `from`; `intensity(direction)` is the vertex's, away from it.
    template <typename Intensity>
    [[nodiscard]] auto light(const Intensity& intensity) const {
        return intensity(-from) * weight;
    }
};

/// `toVertex` leads from the point to the vertex, `normal` is the surface's, on any side; `spread` >= 0, a length,
/// keeps the light of vertices that are closer from falling on one point alone: they are seen lifted off the surface to
/// that height.
///
/// On a plane, a vertex leaves the same flux at any height, whatever it sends where. The others stay where they are, so
/// that the error is of second order in the spread, where vertices are near surfaces as often as elsewhere; and light
/// is never negative, nor more than the one place brings.
inline RegularisedConnection regularisedConnection(const Vec3f& toVertex, const Vec3f& normal, float spread) {
    const float height = toVertex.dot(normal), lift = std::max(spread - std::abs(height), 0.0f);
    const Vec3f seen = toVertex + normal * std::copysign(lift, height);
    const float squared = seen.length2();
    if (!(squared > 0.0f)) return {normal, 0.0f};
    return {seen / std::sqrt(squared), 1.0f / squared};
}

} // namespace tungsten::photon
