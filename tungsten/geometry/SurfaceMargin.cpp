#include "tungsten/geometry/SurfaceMargin.h"

#include "tungsten/geometry/Mesh.h"

namespace tungsten {

namespace {

constexpr float HalfUlp = 0.5f * std::numeric_limits<float>::epsilon();

Vec3f absolute(const Vec3f& v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// a x b with every difference a sum: an upper bound of what the factors' rounding can grow to.
Vec3f crossWithoutCancellation(const Vec3f& a, const Vec3f& b) {
    return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
}

} // namespace

float roundingError(const Vec3f& position, const Vec3f& normal) {
    // On planes through the origin along the axes, what is left is the rounding of double precision.
    constexpr float InDouble = 1e-12f, Least = 1e-30f;
    const Vec3f p = absolute(position);
    return 2.0f * HalfUlp * p.dot(absolute(normal)) + InDouble * (p.x + p.y + p.z) + Least;
}

float roundingError(const TriangleMesh& mesh, uint32_t triangle, float b1, float b2, const Vec3f& position,
                    const Vec3f& normal) {
    const Triangle& corners = mesh.triangles[triangle];
    const Vec3f origin = mesh.positions[corners.v[0]];
    const Vec3f e1 = mesh.positions[corners.v[1]] - origin, e2 = mesh.positions[corners.v[2]] - origin;
    const float area = e1.cross(e2).length();
    if (!(area > 0.0f)) return roundingError(position, normal);
    // A ray test takes the distance (v0 - p) . (e1 x e2) / area to the plane from rounded differences: large triangles
    // that lie along the axes are exact, slivers are far from it.
    constexpr float Steps = 16.0f;
    const Vec3f reach = absolute(e1) * b1 + absolute(e2) * b2;
    const float planeError = reach.dot(crossWithoutCancellation(absolute(e1), absolute(e2))) / area;
    return roundingError(position, normal) + Steps * HalfUlp * planeError;
}

} // namespace tungsten
