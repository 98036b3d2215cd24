// The nearest point of a scene's surfaces. In double precision, so that the direction towards a surface holds where it
// is close by.

#include "tungsten/geometry/SceneGeometry.h"

namespace tungsten {

namespace {

/// Of a segment from `a` along `edge`, nearest to the origin.
Vec3d nearestOnEdge(const Vec3d& a, const Vec3d& edge) {
    const double squared = edge.length2();
    return squared > 0.0 ? a + edge * std::clamp(-a.dot(edge) / squared, 0.0, 1.0) : a;
}

/// Of a triangle with these corners, nearest to the origin; its corner where the triangle's plane is farther than the
/// root of `squaredRadius`, more than by rounding, or which of two faces is nearer would depend on their order.
Vec3d nearestOnTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, double squaredRadius) {
    constexpr double Rounding = 1.0 + 1e-12;
    const Vec3d n = (b - a).cross(c - a);
    const double squared = n.length2(), height = a.dot(n);
    if (height * height > squaredRadius * squared * Rounding && squared > 0.0) return a;
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
    FaceIndex face{};
    std::optional<Vec3d> nearest;

    Query(const std::vector<const Shape*>& all, const Vec3f& from, float radius)
        : shapes(all), position(from), squaredRadius(double(radius) * double(radius)) {}

    /// True where the rest of the search may look less far. Of faces as near as each other the first one is taken, so
    /// that the order of a search does not matter.
    bool consider(const FaceIndex& at) {
        const Vec3d offset = std::visit(
            [&](const auto& shape) { return toShape(shape, at.face, position, squaredRadius); }, *shapes[at.shape]);
        const double squared = offset.length2();
        const bool first = std::pair(at.shape, at.face) < std::pair(face.shape, face.face);
        if (!(squared < squaredRadius || (nearest && squared == squaredRadius && first))) return false;
        squaredRadius = squared;
        nearest = offset;
        face = at;
        return true;
    }
};

/// Asks about all faces no farther than `radius`; visit(face, radius) is true where it has changed the radius.
template <typename Visit>
void pointQuery(RTCScene scene, const Vec3f& position, float radius, Visit& visit) {
    RTCPointQuery about{};
    about.x = position.x;
    about.y = position.y;
    about.z = position.z;
    about.radius = radius;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto call = [](RTCPointQueryFunctionArguments* arguments) {
        return (*static_cast<Visit*>(arguments->userPtr))({arguments->geomID, arguments->primID},
                                                          arguments->query->radius);
    };
    rtcPointQuery(scene, &about, &context, call, &visit);
}

using Plane = SceneGeometry::Plane;

std::optional<Plane> planeOf(const TriangleMesh& mesh, uint32_t face) {
    const Vec3d n = mesh.scaledNormal(face);
    const double length = n.length();
    if (!(length > 0.0)) return std::nullopt;
    return Plane{Vec3d(mesh.positions[mesh.triangles[face].v[0]]), n / length};
}
std::optional<Plane> planeOf(const Sphere&, uint32_t) {
    return std::nullopt;
}
std::optional<Plane> planeOf(const Disk& disk, uint32_t) {
    return Plane{Vec3d(disk.centre), Vec3d(disk.frame.n).normalized()};
}

} // namespace

std::optional<Vec3d> SceneGeometry::toNearest(const Vec3f& position, float radius) const {
    Query query(shapes_, position, radius);
    auto visit = [&](const FaceIndex& face, float& least) {
        if (!query.consider(face)) return false;
        least = float(std::sqrt(query.squaredRadius)) * 1.00001f;
        return true;
    };
    pointQuery(scene_.get(), position, radius, visit);
    return query.nearest;
}

std::optional<SceneGeometry::NearestPoint> SceneGeometry::toNearest(const Vec3f& position, float radius,
                                                                    std::span<const FaceIndex> faces) const {
    Query query(shapes_, position, radius);
    for (const FaceIndex& face : faces) query.consider(face);
    if (!query.nearest) return std::nullopt;
    return NearestPoint{*query.nearest, query.face};
}

std::optional<std::vector<FaceIndex>> SceneGeometry::facesWithin(const Vec3f& position, float radius,
                                                                 size_t most) const {
    std::vector<FaceIndex> found;
    auto visit = [&](const FaceIndex& face, float& least) {
        Query one(shapes_, position, radius);
        if (!one.consider(face)) return false;
        found.push_back(face);
        if (found.size() <= most) return false;
        least = 0.0f;
        return true;
    };
    pointQuery(scene_.get(), position, radius, visit);
    if (found.size() > most) return std::nullopt;
    return found;
}

std::optional<SceneGeometry::Plane> SceneGeometry::planeOf(const FaceIndex& face) const {
    return std::visit([&](const auto& shape) { return tungsten::planeOf(shape, face.face); }, *shapes_[face.shape]);
}

} // namespace tungsten
