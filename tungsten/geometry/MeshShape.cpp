// What a mesh answers as a shape.

#include "tungsten/core/Warp.h"
#include "tungsten/geometry/SceneGeometry.h"

namespace tungsten {

namespace {

/// The point where the ray meets the plane of a triangle, from a corner and the plane's normal of any length. On a vast
/// triangle it is far better known from the ray than from the corners.
Vec3f pointOnPlane(const Vec3f& corner, const Vec3d& n, const Ray& ray, float t) {
    const Vec3d p0(corner), point = Vec3d(ray.origin) + Vec3d(ray.direction) * double(t);
    return Vec3f(point - n * ((point - p0).dot(n) / n.dot(n)));
}

/// A point beside an edge, moved toward the triangle's middle until rounding no longer decides on which side it is of
/// a wall that stands on the edge: a path that goes on from there would miss the wall. A few steps of coordinates.
/// `area2`: twice the triangle's area.
Vec3f clearOfEdges(const TriangleMesh& mesh, const Triangle& triangle, float area2, float b1, float b2,
                   const Vec3f& point) {
    constexpr float Steps = 8.0f * std::numeric_limits<float>::epsilon(), Third = 1.0f / 3.0f;
    const Vec3f corner = mesh.positions[triangle.v[0]];
    const Vec3f e1 = mesh.positions[triangle.v[1]] - corner, e2 = mesh.positions[triangle.v[2]] - corner;
    const float clear = Steps * std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    // Distances to edges are weights times heights, and heights are twice the area over the edge's length.
    const float b0 = 1.0f - b1 - b2, opposite0 = (e2 - e1).length2(), opposite1 = e2.length2(),
                opposite2 = e1.length2();
    const float nearest = std::max(std::min({b0, b1, b2}), 0.0f) * area2;
    if (sqr(nearest) > sqr(clear) * std::max({opposite0, opposite1, opposite2})) return point;
    const auto share = [&](float weight, float opposite) {
        const float least = std::min(clear * std::sqrt(opposite) / area2, Third);
        return least > weight ? (least - weight) / (Third - weight) : 0.0f;
    };
    const float toMiddle = std::max({share(b0, opposite0), share(b1, opposite1), share(b2, opposite2)});
    const Vec3f middle = (e1 + e2) * Third, at = e1 * b1 + e2 * b2;
    return toMiddle > 0.0f ? point + (middle - at) * std::min(toMiddle, 1.0f) : point;
}

/// Six times the volume that it encloses, if it encloses one.
double enclosedVolume(const TriangleMesh& mesh) {
    double volume = 0.0;
    if (mesh.positions.empty()) return volume;
    const Vec3d origin(mesh.positions[0]);
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = Vec3d(mesh.positions[t.v[0]]) - origin, b = Vec3d(mesh.positions[t.v[1]]) - origin,
                    c = Vec3d(mesh.positions[t.v[2]]) - origin;
        volume += a.dot(b.cross(c));
    }
    return std::abs(volume);
}

} // namespace

bool TriangleMesh::isWithin(float limit) const {
    return std::all_of(positions.begin(), positions.end(),
                       [&](const Vec3f& position) { return tungsten::isWithin(position, limit); });
}

bool TriangleMesh::isSheet() const {
    const double size = double(bounds().size().length());
    return enclosedVolume(*this) <= 1e-6 * size * size * size;
}

Imath::Box3f TriangleMesh::bounds() const {
    Imath::Box3f box;
    for (const Vec3f& position : positions) box.extendBy(position);
    return box;
}

BoundingSphere TriangleMesh::boundingSphere() const {
    const Imath::Box3f box = bounds();
    return {box.center(), 0.5f * box.size().length()};
}

float TriangleMesh::area() const {
    double sum = 0.0;
    for (const float face : faceAreas()) sum += double(face);
    return float(sum);
}

std::vector<float> TriangleMesh::faceAreas() const {
    std::vector<float> areas(triangles.size());
    for (size_t i = 0; i < areas.size(); ++i) areas[i] = faceArea(uint32_t(i));
    return areas;
}

SurfaceSample TriangleMesh::samplePoint(const Distribution1D& areas, const Vec2f& u) const {
    if (triangles.empty()) return {Vec3f(0.0f), Vec3f(0.0f, 1.0f, 0.0f), Vec2f(0.0f)};
    const auto chosen = areas.sample(u.x);
    const Triangle& triangle = triangles[chosen.index];
    const Vec2f b = warp::squareToTriangle({chosen.remapped, u.y});
    const float b0 = 1.0f - b.x - b.y;
    const auto blend = [&](const auto& values) {
        return values[triangle.v[0]] * b0 + values[triangle.v[1]] * b.x + values[triangle.v[2]] * b.y;
    };
    const auto face = uint32_t(chosen.index);
    const Vec3f position = pointOn(face, b.x, b.y), normal = faceNormal(face);
    return {position,
            normal,
            uvs.empty() ? Vec2f(0.0f) : blend(uvs),
            roundingError(*this, face, b.x, b.y, position, normal),
            {FaceIndex::None, face}};
}

FacePlane TriangleMesh::facePlane(uint32_t face, const Vec3f& position) const {
    const Vec3d n = scaledNormal(face), offset = Vec3d(position) - Vec3d(positions[triangles[face].v[0]]);
    const double length = std::sqrt(n.dot(n));
    const Vec3f normal = unitOrUp(n);
    return {normal, length > 0.0 ? float(offset.dot(n) / length) : Infinity,
            roundingError(*this, face, 1.0f, 1.0f, position, normal)};
}

/// Tangents from the uvs; any frame about the normal where they are degenerate.
Tangents TriangleMesh::tangents(const SurfaceHit& hit) const {
    const Triangle& triangle = triangles[hit.face];
    if (!uvs.empty()) {
        const Vec2f duv1 = uvs[triangle.v[1]] - uvs[triangle.v[0]];
        const Vec2f duv2 = uvs[triangle.v[2]] - uvs[triangle.v[0]];
        const Vec3f dp1 = positions[triangle.v[1]] - positions[triangle.v[0]];
        const Vec3f dp2 = positions[triangle.v[2]] - positions[triangle.v[0]];
        const float inverse = 1.0f / (duv1.x * duv2.y - duv1.y * duv2.x);
        const Tangents tangents{(dp1 * duv2.y - dp2 * duv1.y) * inverse, (dp2 * duv1.x - dp1 * duv2.x) * inverse};
        const float u2 = tangents.u.length2(), v2 = tangents.v.length2();
        if (std::isfinite(u2) && std::isfinite(v2) && u2 > 0.0f && v2 > 0.0f) return tangents;
    }
    const Frame frame(hit.ng);
    return {frame.s, frame.t};
}

void TriangleMesh::complete(const Ray& ray, const Vec2f& barycentric, SurfaceHit& hit) const {
    const Triangle& triangle = triangles[hit.face];
    const float b1 = barycentric.x, b2 = barycentric.y, b0 = 1.0f - b1 - b2;
    const auto blend = [&](const auto& values) {
        return values[triangle.v[0]] * b0 + values[triangle.v[1]] * b1 + values[triangle.v[2]] * b2;
    };
    hit.material = materials.empty() ? 0 : materials[hit.face];
    const Vec3d normal = scaledNormal(hit.face);
    const Vec3f onPlane = pointOnPlane(positions[triangle.v[0]], normal, ray, hit.t);
    hit.position = clearOfEdges(*this, triangle, float(std::sqrt(normal.dot(normal))), b1, b2, onPlane);
    hit.ng = unitOrUp(normal);
    hit.error = roundingError(*this, hit.face, b1, b2, hit.position, hit.ng);
    hit.ns = hit.ng;
    hit.uv = uvs.empty() ? Vec2f(0.0f) : blend(uvs);
    if (!smooth || normals.empty()) return;
    const Vec3f shading = blend(normals);
    const float length = shading.length();
    if (length > 0.0f && std::isfinite(length)) hit.ns = shading / length;
}

} // namespace tungsten
