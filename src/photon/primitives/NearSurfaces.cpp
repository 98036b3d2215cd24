#include "photon/primitives/NearSurfaces.h"

namespace tungsten::photon {

KernelEdge NearSurfaces::nearest(const Vec3f& position, float radius) const {
    const auto toSurface = geometry_.toNearest(position, radius);
    const double distance = toSurface ? toSurface->length() : 0.0;
    if (!(distance > 0.0)) return {}; // a point on a surface has no side
    return {Vec3f(*toSurface / distance), float(distance)};
}

KernelEdge NearSurfaces::opposite(const Vec3f& position, const KernelEdge& nearest, float radius) const {
    // No surface is nearer than the nearest.
    const float least = std::max(0.5f * nearest.reach, LeastLength * radius);
    const auto hit = geometry_.intersect({position, -nearest.normal, least, radius});
    if (!hit) return {};
    const Vec3f outward = hit->ng.dot(nearest.normal) > 0.0f ? -hit->ng : hit->ng;
    return {outward, std::max(outward.dot(hit->position - position), 0.0f)};
}

bool NearSurfaces::sees(const Vec3f& position, const Vec3f& offset, float radius) const {
    const float length = offset.length(), least = LeastLength * radius;
    return !(length > least) || !geometry_.occluded({position, offset / length, least, length});
}

} // namespace tungsten::photon
