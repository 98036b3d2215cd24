#pragma once
// Rays against spheres and disks, in double precision, and their parametrisations.

#include "tungsten/geometry/SceneGeometry.h"

namespace tungsten {

/// The smallest t in [tMin, tMax] where the ray meets the shape, from either side; negative if there is none.
/// t is rounded to float before it is compared.
float intersectShape(const Sphere& sphere, const Vec3f& origin, const Vec3f& direction, float tMin, float tMax);
float intersectShape(const Disk& disk, const Vec3f& origin, const Vec3f& direction, float tMin, float tMax);

/// The point of the surface in direction `offset` from the centre; nearest to `offset` from it. In double precision up
/// to the coordinates' rounding.
Vec3f pointOn(const Sphere& sphere, const Vec3d& offset);
Vec3f pointOn(const Disk& disk, const Vec3d& offset);

/// Everything of `hit` but shape, face and material, from its t.
void completeHit(const Sphere& sphere, const Ray& ray, SurfaceHit& hit);
void completeHit(const Disk& disk, const Ray& ray, SurfaceHit& hit);
Tangents tangentsOf(const Sphere& sphere, const SurfaceHit& hit);
Tangents tangentsOf(const Disk& disk, const SurfaceHit& hit);

/// u = azimuth / 2 pi + 1/2, v = polar angle / pi of a unit vector in the sphere's frame.
Vec2f sphereUv(const Vec3f& local);
/// u = azimuth / 2 pi + 1/2, v = r / R of a point given in units of the radius.
Vec2f diskUv(const Vec2f& local);

} // namespace tungsten
