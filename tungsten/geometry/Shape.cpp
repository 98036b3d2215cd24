#include "tungsten/geometry/Shape.h"

#include "tungsten/core/Warp.h"

namespace tungsten {

namespace {

Vec2f sphereUv(const Sphere& sphere, const Vec3f& normal) {
    const Vec3f local = sphere.frame.toLocal(normal);
    return {std::atan2(local.y, local.x) * 0.5f * InvPi + 0.5f, std::acos(std::clamp(local.z, -1.0f, 1.0f)) * InvPi};
}

SurfaceSample sampleSurface(const TriangleMesh& mesh, const Distribution1D& triangles, const Vec2f& u) {
    const auto chosen = triangles.sample(u.x);
    const Vec2f b = warp::squareToTriangle({chosen.remapped, u.y});
    const Triangle& triangle = mesh.triangles[chosen.index];
    const auto blend = [&](const auto& values) {
        return values[triangle.v[0]] * (1.0f - b.x - b.y) + values[triangle.v[1]] * b.x + values[triangle.v[2]] * b.y;
    };
    return {blend(mesh.positions), mesh.faceNormal(uint32_t(chosen.index)), mesh.uvs.empty() ? Vec2f(0.0f) : blend(mesh.uvs)};
}

SurfaceSample sampleSurface(const Sphere& sphere, const Distribution1D&, const Vec2f& u) {
    const Vec3f normal = sphere.frame.toWorld(warp::squareToSphere(u));
    return {sphere.centre + normal * sphere.radius, normal, sphereUv(sphere, normal)};
}

SurfaceSample sampleSurface(const Disk& disk, const Distribution1D&, const Vec2f& u) {
    const Vec2f p = warp::squareToDisk(u);
    const Vec2f uv(std::atan2(p.y, p.x) * 0.5f * InvPi + 0.5f, p.length());
    return {disk.centre + (disk.frame.s * p.x + disk.frame.t * p.y) * disk.radius, disk.frame.n, uv};
}

} // namespace

Sphere makeSphere(const Transform& transform) {
    const Vec3f scale = transform.scale();
    return {transform.translation, std::max({scale.x, scale.y, scale.z}), transform.rotation()};
}

Disk makeDisk(const Transform& transform, float coneAngleDegrees) {
    const Vec3f scale = transform.scale();
    return {transform.translation, std::max(scale.x, scale.z), Frame(transform.y.normalized()),
            std::cos(std::min(coneAngleDegrees, 90.0f) * Pi / 180.0f) * (coneAngleDegrees < 90.0f ? 1.0f : 0.0f)};
}

float surfaceArea(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return 4.0f * Pi * sqr(sphere->radius);
    if (const auto* disk = std::get_if<Disk>(&shape)) return Pi * sqr(disk->radius);
    const auto& mesh = std::get<TriangleMesh>(shape);
    double area = 0.0;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) area += double(mesh.faceArea(i));
    return float(area);
}

AreaSampler::AreaSampler(const Shape& shape) : area_(surfaceArea(shape)) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape);
    if (!mesh) return;
    std::vector<float> areas;
    for (uint32_t i = 0; i < mesh->triangles.size(); ++i) areas.push_back(mesh->faceArea(i));
    triangles_ = Distribution1D(areas);
}

SurfaceSample AreaSampler::sample(const Shape& shape, const Vec2f& u) const {
    return std::visit([&](const auto& model) { return sampleSurface(model, triangles_, u); }, shape);
}

} // namespace tungsten
