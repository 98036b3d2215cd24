#pragma once
// The closed set of shapes: triangle meshes (quads and cubes too), spheres, disks. World space.

#include "tungsten/geometry/Mesh.h"
#include "tungsten/geometry/SurfaceMargin.h"

#include "tungsten/core/Distribution.h"

#include <Imath/ImathBox.h>

#include <variant>

namespace tungsten {

struct Sphere {
    Vec3f centre{0, 0, 0};
    float radius = 1.0f;
    Frame frame; ///< local axes: uv azimuth about n (local z)
};

struct Disk {
    Vec3f centre{0, 0, 0};
    float radius = 1.0f;
    Frame frame;               ///< n is the emitting, front side
    float cosConeAngle = 0.0f; ///< emission is seen only inside the cone about n
};

using Shape = std::variant<TriangleMesh, Sphere, Disk>;

/// Sphere of `transform`: radius = largest scale.
Sphere makeSphere(const Transform& transform);
/// Disk of `transform`: radius = max(scale x, scale z), normal = image of +y.
Disk makeDisk(const Transform& transform, float coneAngleDegrees);

float surfaceArea(const Shape& shape);

/// Of the shape itself, no wider.
Imath::Box3f boundsOf(const Shape& shape);

struct BoundingSphere {
    Vec3f centre;
    float radius;
};
/// About the shape; twice the radius is no less than the distance of any two of its points.
BoundingSphere boundingSphere(const Shape& shape);

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

/// Draws points uniformly over a shape's surface.
class AreaSampler {
  public:
    explicit AreaSampler(const Shape& shape);
    [[nodiscard]] SurfaceSample sample(const Shape& shape, const Vec2f& u) const;
    [[nodiscard]] float area() const { return area_; }

  private:
    float area_ = 0.0f;
    Distribution1D triangles_;
};

} // namespace tungsten
