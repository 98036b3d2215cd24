#pragma once
// The set of shapes: triangle meshes (quads and cubes too), spheres, disks.

#include "tungsten/geometry/AnalyticShape.h"
#include "tungsten/geometry/Mesh.h"

namespace tungsten {

using Shape = ShapeSet<TriangleMesh, Sphere, Disk>::Variant;

float surfaceArea(const Shape& shape);

/// Of the shape itself, no wider.
Imath::Box3f boundsOf(const Shape& shape);

/// About the shape; twice the radius is no less than the distance of any two of its points.
BoundingSphere boundingSphere(const Shape& shape);

/// The plane of a face next to a point.
FacePlane facePlane(const Shape& shape, uint32_t face, const Vec3f& position);

/// Draws points uniformly over a shape's surface.
class AreaSampler {
  public:
    explicit AreaSampler(const Shape& shape);
    [[nodiscard]] SurfaceSample sample(const Shape& shape, const Vec2f& u) const;
    [[nodiscard]] float area() const { return area_; }

  private:
    float area_ = 0.0f;
    Distribution1D faces_;
};

} // namespace tungsten
