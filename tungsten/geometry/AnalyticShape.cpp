#include "tungsten/geometry/AnalyticShape.h"

namespace tungsten {

namespace {

bool isWithin(float t, float tMin, float tMax) {
    return t >= tMin && t <= tMax;
}

Tangents anyTangents(const SurfaceHit& hit) {
    const Frame frame(hit.ng);
    return {frame.s, frame.t};
}

} // namespace

float intersectShape(const Sphere& sphere, const Vec3f& origin, const Vec3f& direction, float tMin, float tMax) {
    const Vec3d d(direction), toCentre = Vec3d(sphere.centre) - Vec3d(origin);
    const double radius = double(sphere.radius), a = d.dot(d), b = toCentre.dot(d);
    // The discriminant from the distance of the centre to the line: no cancellation far from the sphere.
    const Vec3d offset = toCentre - d * (b / a);
    const double discriminant = a * (radius * radius - offset.dot(offset));
    if (!(discriminant >= 0.0)) return -1.0f;
    const double q = b + std::copysign(std::sqrt(discriminant), b);
    const double c = toCentre.dot(toCentre) - radius * radius;
    double t0 = q / a, t1 = q != 0.0 ? c / q : 0.0;
    if (t0 > t1) std::swap(t0, t1);
    if (isWithin(float(t0), tMin, tMax)) return float(t0);
    return isWithin(float(t1), tMin, tMax) ? float(t1) : -1.0f;
}

float intersectShape(const Disk& disk, const Vec3f& origin, const Vec3f& direction, float tMin, float tMax) {
    const Vec3d d(direction), n(disk.frame.n), toCentre = Vec3d(disk.centre) - Vec3d(origin);
    const double cosine = d.dot(n);
    if (cosine == 0.0) return -1.0f;
    const double t = toCentre.dot(n) / cosine;
    if (!isWithin(float(t), tMin, tMax)) return -1.0f;
    const Vec3d offset = d * t - toCentre;
    return offset.dot(offset) <= double(disk.radius) * double(disk.radius) ? float(t) : -1.0f;
}

Vec3f pointOn(const Sphere& sphere, const Vec3d& offset) {
    return Vec3f(Vec3d(sphere.centre) + offset * (double(sphere.radius) / std::sqrt(offset.dot(offset))));
}

Vec3f pointOn(const Disk& disk, const Vec3d& offset) {
    const Vec3d n(disk.frame.n);
    return Vec3f(Vec3d(disk.centre) + offset - n * (offset.dot(n) / n.dot(n)));
}

void completeHit(const Sphere& sphere, const Ray& ray, SurfaceHit& hit) {
    const Vec3d offset = Vec3d(ray.origin) + Vec3d(ray.direction) * double(hit.t) - Vec3d(sphere.centre);
    const double length = std::sqrt(offset.dot(offset));
    hit.ng = length > 0.0 ? Vec3f(offset / length) : sphere.frame.n;
    hit.ns = hit.ng;
    hit.position = pointOn(sphere, length > 0.0 ? offset : Vec3d(hit.ng));
    hit.error = roundingError(hit.position, hit.ng);
    const Vec3f local = sphere.frame.toLocal(hit.ng);
    hit.uv = sphereUv(local);
}

void completeHit(const Disk& disk, const Ray& ray, SurfaceHit& hit) {
    const Vec3d offset = Vec3d(ray.origin) + Vec3d(ray.direction) * double(hit.t) - Vec3d(disk.centre);
    const Vec3f s = disk.frame.s, t = disk.frame.t;
    const Vec2f inPlane(float(offset.dot(Vec3d(s))), float(offset.dot(Vec3d(t))));
    hit.ng = hit.ns = disk.frame.n;
    // Back into the plane: t carries a rounding error along the ray.
    hit.position = pointOn(disk, offset);
    hit.error = roundingError(hit.position, hit.ng);
    hit.uv = diskUv(inPlane / disk.radius);
}

Tangents tangentsOf(const Sphere& sphere, const SurfaceHit& hit) {
    const Vec3f local = sphere.frame.toLocal(hit.ng);
    const float sinTheta = std::hypot(local.x, local.y);
    if (sinTheta < 1e-6f) return anyTangents(hit); // the poles
    const float cosPhi = local.x / sinTheta, sinPhi = local.y / sinTheta;
    return {sphere.frame.toWorld({-local.y, local.x, 0.0f}) * (2.0f * Pi * sphere.radius),
            sphere.frame.toWorld({cosPhi * local.z, sinPhi * local.z, -sinTheta}) * (Pi * sphere.radius)};
}

Tangents tangentsOf(const Disk& disk, const SurfaceHit& hit) {
    const Vec3f s = disk.frame.s, t = disk.frame.t, offset = hit.position - disk.centre;
    const Vec2f inPlane(offset.dot(s), offset.dot(t));
    const float radius = inPlane.length();
    if (!(radius > 1e-6f * disk.radius)) return anyTangents(hit); // the centre
    return {(t * inPlane.x - s * inPlane.y) * (2.0f * Pi), (s * inPlane.x + t * inPlane.y) * (disk.radius / radius)};
}

Vec2f sphereUv(const Vec3f& local) {
    return {std::atan2(local.y, local.x) * (0.5f * InvPi) + 0.5f, std::acos(std::clamp(local.z, -1.0f, 1.0f)) * InvPi};
}

Vec2f diskUv(const Vec2f& local) {
    return {std::atan2(local.y, local.x) * (0.5f * InvPi) + 0.5f, std::min(local.length(), 1.0f)};
}

} // namespace tungsten
