// Spheres and disks from transforms; areas; uniform points on surfaces.

#include "tungsten/geometry/Shape.h"

#include "tungsten/core/Overloaded.h"
#include "tungsten/core/Warp.h"
#include "tungsten/geometry/AnalyticShape.h"

namespace tungsten {

namespace {

std::vector<float> faceAreas(const TriangleMesh& mesh) {
    std::vector<float> areas(mesh.triangles.size());
    for (size_t i = 0; i < areas.size(); ++i) areas[i] = mesh.faceArea(uint32_t(i));
    return areas;
}

/// What drawing points needs beside the shape.
Distribution1D faceDistribution(const Shape& shape) {
    return std::visit(Overloaded{[](const TriangleMesh& mesh) { return Distribution1D(faceAreas(mesh)); },
                                 [](const OneOf<Sphere, Disk> auto&) { return Distribution1D(); }},
                      shape);
}

SurfaceSample sampleOn(const TriangleMesh& mesh, const Distribution1D& triangles, const Vec2f& u) {
    if (mesh.triangles.empty()) return {Vec3f(0.0f), Vec3f(0.0f, 1.0f, 0.0f), Vec2f(0.0f)};
    const auto chosen = triangles.sample(u.x);
    const Triangle& triangle = mesh.triangles[chosen.index];
    const Vec2f b = warp::squareToTriangle({chosen.remapped, u.y});
    const float b0 = 1.0f - b.x - b.y;
    const auto blend = [&](const auto& values) {
        return values[triangle.v[0]] * b0 + values[triangle.v[1]] * b.x + values[triangle.v[2]] * b.y;
    };
    const auto face = uint32_t(chosen.index);
    const Vec3f position = mesh.pointOn(face, b.x, b.y), normal = mesh.faceNormal(face);
    return {position,
            normal,
            mesh.uvs.empty() ? Vec2f(0.0f) : blend(mesh.uvs),
            roundingError(mesh, face, b.x, b.y, position, normal),
            {FaceIndex::None, face}};
}

SurfaceSample sampleOn(const Sphere& sphere, const Vec2f& u) {
    const Vec3f local = warp::squareToSphere(u);
    const Vec3f normal = sphere.frame.toWorld(local).normalized();
    const Vec3f position = pointOn(sphere, Vec3d(normal));
    return {position, normal, sphereUv(local), roundingError(position, normal)};
}

SurfaceSample sampleOn(const Disk& disk, const Vec2f& u) {
    const Vec2f local = warp::squareToDisk(u);
    const Vec3f& n = disk.frame.n;
    const Vec3f position = pointOn(disk, Vec3d((disk.frame.s * local.x + disk.frame.t * local.y) * disk.radius));
    return {position, n, diskUv(local), roundingError(position, n)};
}

} // namespace

Sphere makeSphere(const Transform& transform) {
    const Vec3f scale = transform.scale();
    return {transform.translation, std::max(scale.x, std::max(scale.y, scale.z)), transform.rotation()};
}

Disk makeDisk(const Transform& transform, float coneAngleDegrees) {
    const Vec3f scale = transform.scale();
    // A flattened y axis still has a normal: the one perpendicular to the other two.
    const Vec3f up = scale.y > 0.0f ? transform.y.normalized() : transform.z.cross(transform.x).normalized();
    const Vec3f normal = up.length2() > 0.0f ? up : Vec3f(0.0f, 1.0f, 0.0f);
    return {transform.translation, std::max(scale.x, scale.z), Frame(normal),
            coneAngleDegrees < 90.0f ? std::cos(coneAngleDegrees * (Pi / 180.0f)) : 0.0f};
}

Imath::Box3f boundsOf(const Shape& shape) {
    Imath::Box3f box;
    const auto around = [&](const Vec3f& centre, const Vec3f& extent) {
        box.extendBy(centre - extent);
        box.extendBy(centre + extent);
    };
    std::visit(Overloaded{[&](const TriangleMesh& mesh) {
                              for (const Vec3f& position : mesh.positions) box.extendBy(position);
                          },
                          [&](const Sphere& sphere) { around(sphere.centre, Vec3f(sphere.radius)); },
                          [&](const Disk& disk) {
                              const Vec3f& n = disk.frame.n;
                              const auto half = [&](float c) {
                                  return disk.radius * std::sqrt(std::max(1.0f - c * c, 0.0f));
                              };
                              around(disk.centre, {half(n.x), half(n.y), half(n.z)});
                          }},
               shape);
    return box;
}

BoundingSphere boundingSphere(const Shape& shape) {
    return std::visit(Overloaded{[&](const TriangleMesh&) {
                                     const Imath::Box3f box = boundsOf(shape);
                                     return BoundingSphere{box.center(), 0.5f * box.size().length()};
                                 },
                                 [](const OneOf<Sphere, Disk> auto& round) {
                                     return BoundingSphere{round.centre, round.radius};
                                 }},
                      shape);
}

float surfaceArea(const Shape& shape) {
    return std::visit(Overloaded{[](const TriangleMesh& mesh) {
                                     double area = 0.0;
                                     for (const float face : faceAreas(mesh)) area += double(face);
                                     return float(area);
                                 },
                                 [](const Sphere& sphere) { return 4.0f * Pi * sqr(sphere.radius); },
                                 [](const Disk& disk) { return Pi * sqr(disk.radius); }},
                      shape);
}

AreaSampler::AreaSampler(const Shape& shape) : area_(surfaceArea(shape)), triangles_(faceDistribution(shape)) {}

SurfaceSample AreaSampler::sample(const Shape& shape, const Vec2f& u) const {
    return std::visit(Overloaded{[&](const TriangleMesh& mesh) { return sampleOn(mesh, triangles_, u); },
                                 [&](const OneOf<Sphere, Disk> auto& round) { return sampleOn(round, u); }},
                      shape);
}

} // namespace tungsten
