// Surfaces that emit, on the side of their geometric normal.

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/Sampling.h"

namespace tungsten {

EmissionSample sampleEmission(const AreaEmitter& area, const Vec2f& uPosition, const Vec2f& uDirection) {
    const SurfaceSample start = area.areaSampler->sample(*area.shape, uPosition);
    const Vec3f local = warp::squareToCosineHemisphere(uDirection);
    const Vec3f direction = Frame(start.normal).toWorld(local).normalized();
    // L cos / (1/A · cos/pi) = pi A L. A disk's cone does not restrict photons (a rule of the format).
    const Rgb power = area.radiance.rgb(start.uv) * (Pi * area.areaSampler->area());
    return {start.leave(direction), power, warp::squareToCosineHemispherePdf(local), start.normal};
}

std::optional<DirectSample> sampleDirect(const AreaEmitter& area, const Vec3f& receiver, const Vec2f& u) {
    const SurfaceSample point = area.areaSampler->sample(*area.shape, u);
    const Vec3f offset = point.position - receiver;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return std::nullopt;
    const Vec3f direction = offset / distance;
    const float cosine = -direction.dot(point.normal);
    if (cosine <= 0.0f) return std::nullopt;
    if (const auto* disk = std::get_if<Disk>(area.shape); disk && cosine < disk->cosConeAngle) return std::nullopt;
    const float pdf = sqr(distance) / (cosine * area.areaSampler->area());
    return DirectSample{direction, distance, area.radiance.rgb(point.uv) / pdf, pdf, point.position, point.margin()};
}

} // namespace tungsten
