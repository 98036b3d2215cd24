// The nearest point of a scene's surfaces. In double precision, so that the direction towards a surface holds where it
// is close by.

#include "tungsten/geometry/SceneGeometry.h"

#include "tungsten/core/Overloaded.h"

namespace tungsten {

namespace {

/// Of a segment from `a` along `edge`, nearest to the origin.
Vec3d nearestOnEdge(const Vec3d& a, const Vec3d& edge) {
    const double squared = edge.length2();
    return squared > 0.0 ? a + edge * std::clamp(-a.dot(edge) / squared, 0.0, 1.0) : a;
}

/// Of a triangle with these corners, nearest to the origin; its corner where the triangle's plane is farther than the
/// root of `squaredRadius`.
Vec3d nearestOnTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, double squaredRadius) {
    const Vec3d n = (b - a).cross(c - a);
    const double squared = n.length2(), height = a.dot(n);
    if (height * height >= squaredRadius * squared && squared > 0.0) return a;
    const auto inside = [&](const Vec3d& from, const Vec3d& to) { return (to - from).cross(-from).dot(n) >= 0.0; };
    if (squared > 0.0 && inside(a, b) && inside(b, c) && inside(c, a)) return n * (height / squared);
    Vec3d nearest = nearestOnEdge(a, b - a);
    for (const Vec3d& other : {nearestOnEdge(b, c - b), nearestOnEdge(c, a - c)})
        if (other.length2() < nearest.length2()) nearest = other;
    return nearest;
}

Vec3d toShape(const TriangleMesh& mesh, uint32_t face, const Vec3d& position, double squaredRadius) {
    const Triangle& triangle = mesh.triangles[face];
    const auto corner = [&](int k) { return Vec3d(mesh.positions[triangle.v[k]]) - position; };
    return nearestOnTriangle(corner(0), corner(1), corner(2), squaredRadius);
}
Vec3d toShape(const Sphere& sphere, uint32_t, const Vec3d& position, double) {
    const Vec3d fromCentre = position - Vec3d(sphere.centre);
    const double distance = fromCentre.length();
    const Vec3d outward = distance > 0.0 ? fromCentre / distance : Vec3d(sphere.frame.n);
    return outward * (double(sphere.radius) - distance);
}
Vec3d toShape(const Disk& disk, uint32_t, const Vec3d& position, double) {
    const Vec3d n = Vec3d(disk.frame.n).normalized(), fromCentre = position - Vec3d(disk.centre);
    const Vec3d across = fromCentre - n * fromCentre.dot(n);
    const double distance = across.length(), radius = double(disk.radius);
    return (distance > radius ? across * (radius / distance) : across) - fromCentre;
}

struct Query {
    const std::vector<const Shape*>& shapes;
    Vec3d position;
    double squaredRadius;
    std::optional<Vec3d> nearest;
};

/// True where the rest of the search may look less far.
bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const Vec3d offset = std::visit(
        [&](const auto& shape) { return toShape(shape, arguments->primID, query.position, query.squaredRadius); },
        *query.shapes[arguments->geomID]);
    const double squared = offset.length2();
    if (!(squared < query.squaredRadius)) return false;
    query.squaredRadius = squared;
    query.nearest = offset;
    arguments->query->radius = float(std::sqrt(squared)) * 1.00001f;
    return true;
}

} // namespace

std::optional<Vec3d> SceneGeometry::toNearest(const Vec3f& position, float radius) const {
    Query query{shapes_, Vec3d(position), double(radius) * double(radius), std::nullopt};
    RTCPointQuery about{};
    about.x = position.x;
    about.y = position.y;
    about.z = position.z;
    about.radius = radius;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_.get(), &about, &context, visit, &query);
    return query.nearest;
}

} // namespace tungsten
