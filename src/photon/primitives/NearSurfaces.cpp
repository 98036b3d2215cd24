#include "photon/primitives/NearSurfaces.h"

#include "photon/Tuning.h"

namespace tungsten::photon {

namespace {

float largestCell(const SceneGeometry& geometry) {
    const float across = (geometry.boundsMax() - geometry.boundsMin()).length();
    return across > 0.0f && across < Infinity ? across / tuning::LeastCellsAcross : 1.0f;
}

KernelEdge edgeTowards(const std::optional<Vec3d>& surface) {
    const double distance = surface ? surface->length() : 0.0;
    if (!(distance > 0.0)) return {}; // a point on a surface has no side
    return {Vec3f(*surface / distance), float(distance)};
}

} // namespace

NearSurfaces::NearSurfaces(const Scene& scene, float radius, float reachInRadii)
    : NearSurfaces(*scene.geometry, std::min(tuning::CellInRadii * radius, largestCell(*scene.geometry)), radius,
                   reachInRadii) {}

NearSurfaces::NearSurfaces(const SceneGeometry& geometry, float size, float radius, float reachInRadii)
    : geometry_(geometry), cells_(geometry, size, reachInRadii * std::min(radius, size) * (1.0f + LeastLength)) {}

NearSurfaces::Nearest NearSurfaces::nearest(const Vec3f& position, float radius) const {
    const auto [least, most] = cells_.distance(position);
    if (least >= radius) return {};
    // A search that knows how far it must look leaves most faces out.
    const float far = std::min(radius, most);
    if (radius > cells_.reach()) return {edgeTowards(geometry_.toNearest(position, far))};
    return cells_.withFaces(position, [&, far = far](const SurfaceCells::Faces& faces) -> Nearest {
        if (faces.tooMany) return {edgeTowards(geometry_.toNearest(position, far))};
        return nearestOf(faces, position, radius);
    });
}

NearSurfaces::Nearest NearSurfaces::nearestOf(const SurfaceCells::Faces& faces, const Vec3f& position,
                                              float radius) const {
    constexpr double Rounding = 1.0 + 1e-9;
    std::optional<SceneGeometry::NearestPoint> best;
    const SurfaceCells::Group* of = nullptr;
    std::array<const SurfaceCells::Group*, SurfaceCells::MostFaces> near;
    size_t count = 0;
    const auto height = [&](const SurfaceCells::Group& group) {
        return (group.plane->point - Vec3d(position)).dot(group.plane->normal);
    };
    for (const SurfaceCells::Group& group : faces.groups) {
        if (group.plane && std::abs(height(group)) > double(radius) * Rounding) continue;
        const auto found = geometry_.toNearest(position, radius, group.faces);
        if (!found) continue;
        near[count++] = &group;
        const auto order = [](const SceneGeometry::NearestPoint& point) {
            return std::tuple(point.offset.length2(), point.face.shape, point.face.face);
        };
        if (best && order(*best) < order(*found)) continue;
        best = found;
        of = &group;
    }
    if (!best) return {};
    const KernelEdge edge = edgeTowards(best->offset);
    // At the rim of a face the way to it is not along the face's normal.
    constexpr double Along = 1e-12;
    const bool straight = of->plane && best->offset.cross(of->plane->normal).length2() < Along * best->offset.length2();
    if (straight && count == 1) return {edge, true, false};
    // The way opposite() looks, as far as the radius.
    const Vec3d way = Vec3d(edge.normal) * -double(radius);
    const auto meets = [&](const SurfaceCells::Group* group) {
        if (!group->plane) return true;
        const double from = height(*group), to = from - way.dot(group->plane->normal);
        return from * to <= 0.0 || std::abs(to) < 1e-3 * double(radius);
    };
    return {edge, false, std::any_of(near.begin(), near.begin() + count, meets)};
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
