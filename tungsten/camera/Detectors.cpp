#include "tungsten/camera/Detectors.h"

#include "tungsten/core/Warp.h"

#include <cmath>

namespace tungsten {

double Detector::etendue() const {
    return double(Pi) * double(Pi) * double(radius) * double(radius) * double(aperture) * double(aperture);
}

Ray Detector::sampleRay(const Vec2f& uPlace, const Vec2f& uDirection) const {
    // A direction's projected solid angle is the area of its foot on the unit disc.
    const Vec2f foot = warp::squareToDisk(uDirection) * aperture;
    const Vec3f local(foot.x, foot.y, std::sqrt(std::max(1.0f - sqr(foot.x) - sqr(foot.y), 0.0f)));
    return {samplePoint(uPlace), frame.toWorld(local).normalized()};
}

Vec3f Detector::samplePoint(const Vec2f& u) const {
    const Vec2f disk = warp::squareToDisk(u) * radius;
    return position + frame.s * disk.x + frame.t * disk.y;
}

float Detector::pdfPoint(const Vec3f& direction, float distance) const {
    return sqr(distance) / (Pi * sqr(radius) * std::max(-direction.dot(frame.n), 1e-20f));
}

bool Detector::accepts(const Vec3f& towards) const {
    const Vec3f local = frame.toLocal(towards);
    return local.z > 0.0f && sqr(local.x) + sqr(local.y) <= sqr(aperture);
}

std::optional<float> Detector::intersect(const Ray& ray) const {
    if (!accepts(-ray.direction)) return std::nullopt;
    const Vec3f offset = position - ray.origin;
    const float length = offset.dot(frame.n) / ray.direction.dot(frame.n);
    // The foot from the middle, not from the origin of a ray that comes from afar.
    const Vec3f foot = ray.direction * length - offset;
    if (!(length > ray.tMin && length < ray.tMax) || foot.length2() > sqr(radius)) return std::nullopt;
    return length;
}

std::optional<SensorSample> Detectors::sample(size_t index, const Vec3f& point, const Vec2f& u) const {
    const Detector& detector = row[index];
    const Vec3f offset = detector.samplePoint(u) - point;
    const float distance = offset.length();
    const Vec3f direction = offset / distance;
    if (!(distance > 0.0f) || !detector.accepts(-direction)) return std::nullopt;
    const float area = Pi * sqr(detector.radius), cosine = -direction.dot(detector.frame.n);
    const float weight = area * cosine / (sqr(distance) * float(detector.etendue()));
    return SensorSample{direction, distance, weight, {float(index), 0.0f}};
}

} // namespace tungsten
