#pragma once
// Spheres and disks, met by rays in double precision, and their parametrisations.

#include "tungsten/core/Transform.h"
#include "tungsten/geometry/ShapeModel.h"

namespace tungsten {

class ShapeReader;

struct Sphere {
    static constexpr const char* Type = "sphere";
    Vec3f centre{0, 0, 0};
    float radius = 1.0f;
    Frame frame; ///< local axes: uv azimuth about n (local z)

    static Sphere read(const ShapeReader& fields);
    [[nodiscard]] bool isEmpty() const { return false; }
    [[nodiscard]] size_t faceCount() const { return 1; }
    [[nodiscard]] size_t triangleCount() const { return 0; }
    [[nodiscard]] bool isWithin(float limit) const;
    [[nodiscard]] bool isSheet() const { return false; }
    [[nodiscard]] Imath::Box3f bounds() const;
    [[nodiscard]] BoundingSphere boundingSphere() const { return {centre, radius}; }
    [[nodiscard]] float area() const { return 4.0f * Pi * sqr(radius); }
    [[nodiscard]] std::vector<float> faceAreas() const { return {}; }
    [[nodiscard]] SurfaceSample samplePoint(const Distribution1D& areas, const Vec2f& u) const;
    [[nodiscard]] FacePlane facePlane(uint32_t face, const Vec3f& position) const;
    [[nodiscard]] Tangents tangents(const SurfaceHit& hit) const;
    void complete(const Ray& ray, const Vec2f& barycentric, SurfaceHit& hit) const;
};

struct Disk {
    static constexpr const char* Type = "disk";
    Vec3f centre{0, 0, 0};
    float radius = 1.0f;
    Frame frame;               ///< n is the emitting, front side
    float cosConeAngle = 0.0f; ///< emission is seen only inside the cone about n

    static Disk read(const ShapeReader& fields);
    [[nodiscard]] bool isEmpty() const { return false; }
    [[nodiscard]] size_t faceCount() const { return 1; }
    [[nodiscard]] size_t triangleCount() const { return 0; }
    [[nodiscard]] bool isWithin(float limit) const;
    [[nodiscard]] bool isSheet() const { return true; }
    [[nodiscard]] Imath::Box3f bounds() const;
    [[nodiscard]] BoundingSphere boundingSphere() const { return {centre, radius}; }
    [[nodiscard]] float area() const { return Pi * sqr(radius); }
    [[nodiscard]] std::vector<float> faceAreas() const { return {}; }
    [[nodiscard]] SurfaceSample samplePoint(const Distribution1D& areas, const Vec2f& u) const;
    [[nodiscard]] FacePlane facePlane(uint32_t face, const Vec3f& position) const;
    [[nodiscard]] Tangents tangents(const SurfaceHit& hit) const;
    void complete(const Ray& ray, const Vec2f& barycentric, SurfaceHit& hit) const;
};

/// Sphere of `transform`: radius = largest scale.
Sphere makeSphere(const Transform& transform);
/// Disk of `transform`: radius = max(scale x, scale z), normal = image of +y.
Disk makeDisk(const Transform& transform, float coneAngleDegrees);

/// The smallest t in [tMin, tMax] where the ray meets the shape, from either side; negative if there is none.
/// t is rounded to float before it is compared.
float intersectShape(const Sphere& sphere, const Vec3f& origin, const Vec3f& direction, float tMin, float tMax);
float intersectShape(const Disk& disk, const Vec3f& origin, const Vec3f& direction, float tMin, float tMax);

/// The point of the surface in direction `offset` from the centre; nearest to `offset` from it. In double precision up
/// to the coordinates' rounding.
Vec3f pointOn(const Sphere& sphere, const Vec3d& offset);
Vec3f pointOn(const Disk& disk, const Vec3d& offset);

} // namespace tungsten
