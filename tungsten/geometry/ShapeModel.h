#pragma once
// What a shape answers, in world space.

#include "tungsten/core/Distribution.h"
#include "tungsten/core/ModelSet.h"
#include "tungsten/geometry/SurfaceMargin.h"

#include <Imath/ImathBox.h>

#include <concepts>

namespace tungsten {

struct SurfaceHit;

struct BoundingSphere {
    Vec3f centre;
    float radius;
};

/// A point on a surface, uniform by area; density 1 / area per unit area.
struct SurfaceSample {
    Vec3f position;
    Vec3f normal; ///< geometric
    Vec2f uv;
    float error = 0.0f; ///< of the margin; 0: a point in space
    FaceIndex face{};   ///< its shape is set by who knows the scene

    [[nodiscard]] SurfaceMargin margin() const { return {normal, error, face}; }
    /// A ray from here that does not meet the surface here.
    [[nodiscard]] Ray spawnRay(const Vec3f& direction) const { return margin().spawnRay(position, direction); }
};

/// The plane of a face next to a point: its own normal, unit, how far the point is along it, and how far off a ray test
/// may put the face.
struct FacePlane {
    Vec3f normal;
    float height, error;
};

/// No coordinate is larger.
inline bool isWithin(const Vec3f& p, float limit) {
    return std::abs(p.x) <= limit && std::abs(p.y) <= limit && std::abs(p.z) <= limit;
}

template <typename M>
concept ShapeModel = std::copyable<M> && requires(const M& m, uint32_t face, const Vec3f& position, const Vec2f& u,
                                                  const Distribution1D& areas, const Ray& ray, SurfaceHit& hit) {
    { m.isEmpty() } -> std::same_as<bool>;     // without a face
    { m.faceCount() } -> std::same_as<size_t>; // numbered from 0
    { m.triangleCount() } -> std::same_as<size_t>;
    { m.isWithin(1.0f) } -> std::same_as<bool>; // no coordinate lies further out
    { m.isSheet() } -> std::same_as<bool>;      // encloses nothing
    { m.bounds() } -> std::same_as<Imath::Box3f>;
    { m.boundingSphere() } -> std::same_as<BoundingSphere>;
    { m.area() } -> std::same_as<float>;
    { m.faceAreas() } -> std::same_as<std::vector<float>>;      // none where points are drawn without
    { m.samplePoint(areas, u) } -> std::same_as<SurfaceSample>; // uniform by area
    { m.facePlane(face, position) } -> std::same_as<FacePlane>;
    { m.tangents(hit) } -> std::same_as<Tangents>; // any two across the normal where it has no coordinates
    m.complete(ray, u, hit);                       // all of the hit but shape, face and t; `u` is barycentric
};
template <ShapeModel M>
using CheckedShape = M;
template <typename... M>
using ShapeSet = ModelSet<CheckedShape<M>...>;

} // namespace tungsten
