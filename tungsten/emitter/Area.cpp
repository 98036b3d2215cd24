// Surfaces that emit, on the side of their geometric normal.

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/Sampling.h"

namespace tungsten {

SurfaceSample AreaEmitter::samplePoint(const Vec2f& u) const {
    SurfaceSample point = areaSampler->sample(*shape, u);
    point.face.shape = primitive;
    return point;
}

float AreaEmitter::cosCone() const {
    return std::visit(Overloaded{[](const Disk& disk) { return disk.cosConeAngle; },
                                 [](const OneOf<TriangleMesh, Sphere> auto&) { return 0.0f; }},
                      *shape);
}

float AreaEmitter::extent() const {
    return Pi * (1.0f - sqr(cosCone())) * areaSampler->area();
}

EmissionSample sampleEmission(const AreaEmitter& area, const Vec2f& uPosition, const Vec2f& uDirection) {
    const SurfaceSample start = area.samplePoint(uPosition);
    const float cone = area.cosCone();
    const Vec3f local = warp::squareToCosineCone(uDirection, cone);
    const Vec3f direction = Frame(start.normal).toWorld(local).normalized();
    const Rgb power = area.radiance.rgb(start.uv) * area.extent(); // L cos over the densities of position and direction
    return {start.spawnRay(direction), power, warp::squareToCosineConePdf(local, cone), start.normal};
}

std::optional<DirectSample> sampleDirect(const AreaEmitter& area, const Vec3f& receiver, const Vec2f& u) {
    const SurfaceSample point = area.samplePoint(u);
    const Vec3f offset = point.position - receiver;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return std::nullopt;
    const Vec3f direction = offset / distance;
    const float cosine = -direction.dot(point.normal);
    if (!area.shinesAt(cosine)) return std::nullopt;
    const float pdf = sqr(distance) / (cosine * area.areaSampler->area());
    return DirectSample{direction, distance, area.radiance.rgb(point.uv) / pdf, pdf, point.position, point.margin()};
}

} // namespace tungsten
