// Emitters that have a position but no surface: point, spot, directional_point, collimated.

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/Sampling.h"

namespace tungsten {

float SpotEmitter::falloff(float cosTheta) const {
    if (cosTheta <= cosOuter) return 0.0f;
    if (cosTheta >= cosInner) return 1.0f;
    const float x = (cosTheta - cosOuter) / (cosInner - cosOuter);
    return x * x * (3.0f - 2.0f * x);
}

EmissionSample sampleEmission(const PointEmitter& point, const Vec2f&, const Vec2f& uDirection) {
    const Vec3f direction = warp::squareToSphere(uDirection);
    const float pdf = warp::squareToSpherePdf();
    return {{point.position, direction}, point.intensity / pdf, pdf, direction};
}

EmissionSample sampleEmission(const SpotEmitter& spot, const Vec2f&, const Vec2f& uDirection) {
    const Vec3f local = warp::squareToCone(uDirection, spot.cosOuter);
    const Vec3f direction = Frame(spot.direction).toWorld(local).normalized();
    const float pdf = warp::squareToConePdf(spot.cosOuter);
    return {{spot.position, direction}, spot.intensity * (spot.falloff(local.z) / pdf), pdf, direction};
}

EmissionSample sampleEmission(const DirectionalPointEmitter& laser, const Vec2f&, const Vec2f&) {
    return {{laser.position, laser.direction}, laser.power, 0.0f, laser.direction};
}

EmissionSample sampleEmission(const CollimatedEmitter& laser, const Vec2f& uPosition, const Vec2f&) {
    const Vec2f disk = warp::squareToDisk(uPosition) * laser.radius;
    const Vec3f origin = laser.position + laser.frame.s * disk.x + laser.frame.t * disk.y;
    return {{origin, laser.frame.n}, laser.power, 0.0f, laser.frame.n};
}

namespace {

/// Toward a point source: intensity / distance^2.
std::optional<DirectSample> connectToPoint(const Vec3f& position, const Vec3f& receiver) {
    const Vec3f offset = position - receiver;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return std::nullopt;
    return DirectSample{offset / distance, distance, Rgb(1.0f / sqr(distance)), 0.0f, position};
}

} // namespace

std::optional<DirectSample> sampleDirect(const PointEmitter& point, const Vec3f& receiver, const Vec2f&) {
    auto sample = connectToPoint(point.position, receiver);
    if (sample) sample->weight = sample->weight * point.intensity;
    return sample;
}

std::optional<DirectSample> sampleDirect(const SpotEmitter& spot, const Vec3f& receiver, const Vec2f&) {
    auto sample = connectToPoint(spot.position, receiver);
    if (!sample) return sample;
    const float falloff = spot.falloffTowards(-sample->direction);
    if (falloff <= 0.0f) return std::nullopt;
    sample->weight = sample->weight * spot.intensity * falloff;
    return sample;
}

} // namespace tungsten
