#include "tungsten/geometry/AnalyticShape.h"

#include "tungsten/core/Warp.h"
#include "tungsten/geometry/SceneGeometry.h"
#include "tungsten/geometry/ShapeReader.h"

namespace tungsten {

namespace {

bool isBetween(float t, float tMin, float tMax) {
    return t >= tMin && t <= tMax;
}

Tangents anyTangents(const SurfaceHit& hit) {
    const Frame frame(hit.ng);
    return {frame.s, frame.t};
}

/// u = azimuth / 2 pi + 1/2, v = polar angle / pi of a unit vector in the sphere's frame.
Vec2f sphereUv(const Vec3f& local) {
    return {std::atan2(local.y, local.x) * (0.5f * InvPi) + 0.5f, std::acos(std::clamp(local.z, -1.0f, 1.0f)) * InvPi};
}

/// u = azimuth / 2 pi + 1/2, v = r / R of a point given in units of the radius.
Vec2f diskUv(const Vec2f& local) {
    return {std::atan2(local.y, local.x) * (0.5f * InvPi) + 0.5f, std::min(local.length(), 1.0f)};
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
    if (isBetween(float(t0), tMin, tMax)) return float(t0);
    return isBetween(float(t1), tMin, tMax) ? float(t1) : -1.0f;
}

float intersectShape(const Disk& disk, const Vec3f& origin, const Vec3f& direction, float tMin, float tMax) {
    const Vec3d d(direction), n(disk.frame.n), toCentre = Vec3d(disk.centre) - Vec3d(origin);
    const double cosine = d.dot(n);
    if (cosine == 0.0) return -1.0f;
    const double t = toCentre.dot(n) / cosine;
    if (!isBetween(float(t), tMin, tMax)) return -1.0f;
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

void Sphere::complete(const Ray& ray, const Vec2f&, SurfaceHit& hit) const {
    const Vec3d offset = Vec3d(ray.origin) + Vec3d(ray.direction) * double(hit.t) - Vec3d(centre);
    const double length = std::sqrt(offset.dot(offset));
    hit.ng = length > 0.0 ? Vec3f(offset / length) : frame.n;
    hit.ns = hit.ng;
    hit.position = pointOn(*this, length > 0.0 ? offset : Vec3d(hit.ng));
    hit.error = roundingError(hit.position, hit.ng);
    const Vec3f local = frame.toLocal(hit.ng);
    hit.uv = sphereUv(local);
}

void Disk::complete(const Ray& ray, const Vec2f&, SurfaceHit& hit) const {
    const Vec3d offset = Vec3d(ray.origin) + Vec3d(ray.direction) * double(hit.t) - Vec3d(centre);
    const Vec3f s = frame.s, t = frame.t;
    const Vec2f inPlane(float(offset.dot(Vec3d(s))), float(offset.dot(Vec3d(t))));
    hit.ng = hit.ns = frame.n;
    // Back into the plane: t carries a rounding error along the ray.
    hit.position = pointOn(*this, offset);
    hit.error = roundingError(hit.position, hit.ng);
    hit.uv = diskUv(inPlane / radius);
}

Tangents Sphere::tangents(const SurfaceHit& hit) const {
    const Vec3f local = frame.toLocal(hit.ng);
    const float sinTheta = std::hypot(local.x, local.y);
    if (sinTheta < 1e-6f) return anyTangents(hit); // the poles
    const float cosPhi = local.x / sinTheta, sinPhi = local.y / sinTheta;
    return {frame.toWorld({-local.y, local.x, 0.0f}) * (2.0f * Pi * radius),
            frame.toWorld({cosPhi * local.z, sinPhi * local.z, -sinTheta}) * (Pi * radius)};
}

Tangents Disk::tangents(const SurfaceHit& hit) const {
    const Vec3f s = frame.s, t = frame.t, offset = hit.position - centre;
    const Vec2f inPlane(offset.dot(s), offset.dot(t));
    const float distance = inPlane.length();
    if (!(distance > 1e-6f * radius)) return anyTangents(hit); // the centre
    return {(t * inPlane.x - s * inPlane.y) * (2.0f * Pi), (s * inPlane.x + t * inPlane.y) * (radius / distance)};
}

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

namespace {

Imath::Box3f boxAround(const Vec3f& centre, const Vec3f& extent) {
    Imath::Box3f box;
    box.extendBy(centre - extent);
    box.extendBy(centre + extent);
    return box;
}

} // namespace

Sphere Sphere::read(const ShapeReader& fields) {
    return makeSphere(fields.placement);
}

bool Sphere::isWithin(float limit) const {
    return tungsten::isWithin(centre, limit) && radius <= limit;
}

Imath::Box3f Sphere::bounds() const {
    return boxAround(centre, Vec3f(radius));
}

FacePlane Sphere::facePlane(uint32_t, const Vec3f& position) const {
    const Vec3d offset = Vec3d(position) - Vec3d(centre);
    const double length = std::sqrt(offset.dot(offset));
    const Vec3f normal = length > 0.0 ? Vec3f(offset / length) : frame.n;
    return {normal, float(length - double(radius)), roundingError(position, normal)};
}

SurfaceSample Sphere::samplePoint(const Distribution1D&, const Vec2f& u) const {
    const Vec3f local = warp::squareToSphere(u);
    const Vec3f normal = frame.toWorld(local).normalized();
    const Vec3f position = pointOn(*this, Vec3d(normal));
    return {position, normal, sphereUv(local), roundingError(position, normal)};
}

Disk Disk::read(const ShapeReader& fields) {
    return makeDisk(fields.placement,
                    float(fields.number("cone_angle", 90.0, {"degrees", "it emits within that angle of its normal"},
                                        {0.0, 180.0})));
}

bool Disk::isWithin(float limit) const {
    return tungsten::isWithin(centre, limit) && radius <= limit;
}

Imath::Box3f Disk::bounds() const {
    const auto half = [&](float c) { return radius * std::sqrt(std::max(1.0f - c * c, 0.0f)); };
    return boxAround(centre, {half(frame.n.x), half(frame.n.y), half(frame.n.z)});
}

FacePlane Disk::facePlane(uint32_t, const Vec3f& position) const {
    const Vec3d n(frame.n);
    return {frame.n, float((Vec3d(position) - Vec3d(centre)).dot(n) / std::sqrt(n.dot(n))),
            roundingError(position, frame.n)};
}

SurfaceSample Disk::samplePoint(const Distribution1D&, const Vec2f& u) const {
    const Vec2f local = warp::squareToDisk(u);
    const Vec3f& n = frame.n;
    const Vec3f position = pointOn(*this, Vec3d((frame.s * local.x + frame.t * local.y) * radius));
    return {position, n, diskUv(local), roundingError(position, n)};
}

} // namespace tungsten
