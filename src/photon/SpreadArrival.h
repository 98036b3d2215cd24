#pragma once
// Light that arrives at a sensor point from close by, spread over the surface about the point.

#include "tungsten/core/Types.h"

namespace tungsten::photon {

/// A flight from a vertex as a sensor point sees it: a difference of two, from where the vertex would be if it were
/// lifted off the surface once and twice.
struct SpreadArrival {
    Vec3f from, fromFurther; ///< unit directions towards the lifted vertices
    float weight, further;   ///< instead of 1 / squared distance; at most 2 / spread^2 and as much

    /// What arrives, to be reflected as coming along `from`; `intensity(direction)` is the vertex's, away from it.
    template <typename Intensity>
    [[nodiscard]] auto light(const Intensity& intensity) const {
        return intensity(-from) * weight - intensity(-fromFurther) * further;
    }
};

/// `toVertex` leads from the point to the vertex, `normal` is the surface's, on any side; `spread` >= 0, a length,
/// keeps the light of vertices that are closer from falling on one point alone.
///
/// On a plane, a vertex at height h and twice the height leave the same flux whatever they send where; lifting it by r
/// blurs its irradiance over a length of about r. For an even vertex the irradiance is 2 pi times the Poisson kernel
/// P_h(rho) = h / (2 pi (h^2 + rho^2)^(3/2)) of the half-space, P_h * P_r = P_(h + r), and lifting is that blur. For
/// the irradiance f(h) the result is 2 f(h + r) - f(h + 2r): it keeps the flux and has no error of first order in r.
inline SpreadArrival spreadArrival(const Vec3f& toVertex, const Vec3f& normal, float spread) {
    const float height = toVertex.dot(normal), h = std::abs(height), r = spread;
    const Vec3f lift = normal * std::copysign(r, height), once = toVertex + lift, twice = once + lift;
    const float squared = once.length2(), squaredTwice = twice.length2();
    if (!(squared > 0.0f)) return {normal, normal, 0.0f, 0.0f};
    // P_(h + 2r) / P_(h + r)
    const float part = squared / squaredTwice;
    const float ratio = h + r > 0.0f ? (h + 2.0f * r) / (h + r) * part * std::sqrt(part) : 1.0f;
    return {once / std::sqrt(squared), twice / std::sqrt(squaredTwice), 2.0f / squared, ratio / squared};
}

} // namespace tungsten::photon
