// Spheres and disks from transforms; areas; uniform points on surfaces.

#include "tungsten/geometry/Shape.h"

#include "tungsten/core/Warp.h"
#include "tungsten/geometry/AnalyticShape.h"

namespace tungsten {

namespace {

std::vector<float> faceAreas(const Shape& shape) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape);
    if (!mesh) return {};
    std::vector<float> areas(mesh->triangles.size());
    for (size_t i = 0; i < areas.size(); ++i) areas[i] = mesh->faceArea(uint32_t(i));
    return areas;
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
    return {position, normal, mesh.uvs.empty() ? Vec2f(0.0f) : blend(mesh.uvs),
            roundingError(mesh, face, b.x, b.y, position, normal)};
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
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
        for (const Vec3f& position : mesh->positions) box.extendBy(position);
        return box;
    }
    const auto around = [&](const Vec3f& centre, const Vec3f& extent) {
        box.extendBy(centre - extent);
        box.extendBy(centre + extent);
    };
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        around(sphere->centre, Vec3f(sphere->radius));
    } else {
        const Disk& disk = std::get<Disk>(shape);
        const Vec3f& n = disk.frame.n;
        const auto half = [&](float c) { return disk.radius * std::sqrt(std::max(1.0f - c * c, 0.0f)); };
        around(disk.centre, {half(n.x), half(n.y), half(n.z)});
    }
    return box;
}

float surfaceArea(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return 4.0f * Pi * sqr(sphere->radius);
    if (const auto* disk = std::get_if<Disk>(&shape)) return Pi * sqr(disk->radius);
    double area = 0.0;
    for (const float face : faceAreas(shape)) area += double(face);
    return float(area);
}

AreaSampler::AreaSampler(const Shape& shape) : area_(surfaceArea(shape)), triangles_(faceAreas(shape)) {}

SurfaceSample AreaSampler::sample(const Shape& shape, const Vec2f& u) const {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return sampleOn(*sphere, u);
    if (const auto* disk = std::get_if<Disk>(&shape)) return sampleOn(*disk, u);
    return sampleOn(std::get<TriangleMesh>(shape), triangles_, u);
}

} // namespace tungsten
