#pragma once
// Light that arrives at a sensor point from close by, spread over the surface about the point.

#include "tungsten/core/Types.h"

namespace tungsten::photon {

/// A flight from a vertex as a sensor point sees it.
struct SpreadArrival {
    Vec3f from;     ///< unit direction that the light seems to come from
    float geometry; ///< 1 / squared distance, but bounded: at most 2 / spread^2
};

/// `toVertex` leads from the point to the vertex, `normal` is the surface's, on any side; `spread` >= 0, a length,
/// keeps the light of vertices that are closer from falling on one point alone.
///
/// In the plane of the point, the irradiance h / (h^2 + rho^2)^(3/2) of a vertex at height h is 2 pi times the Poisson
/// kernel P_h of the half-space, for which P_h * P_r = P_(h + r): to blur it is to lift the vertex. The blur here is
/// 2 P_r - P_2r, r the spread. It is positive, has no error of first order (its transform is 1 - k^2 r^2 + ...) and
/// keeps the light: the irradiance is that of the vertex lifted by r, times 2 - P_(h + 2r) / P_(h + r).
inline SpreadArrival spreadArrival(const Vec3f& toVertex, const Vec3f& normal, float spread) {
    const float height = toVertex.dot(normal), h = std::abs(height), r = spread;
    const Vec3f lifted = toVertex + normal * std::copysign(r, height);
    const float once = lifted.length2(), twice = once + r * (2.0f * h + 3.0f * r);
    if (!(once > 0.0f)) return {normal, 0.0f};
    // P_(h + 2r) / P_(h + r)
    const float ratio = h + r > 0.0f ? (h + 2.0f * r) / (h + r) * (once / twice) * std::sqrt(once / twice) : 1.0f;
    return {lifted / std::sqrt(once), (2.0f - ratio) / once};
}

} // namespace tungsten::photon
