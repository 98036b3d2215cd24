#include "tungsten/emitter/Area.h"

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/EmitterReader.h"

namespace tungsten {

SurfaceSample AreaEmitter::samplePoint(const Vec2f& u) const {
    SurfaceSample point = areaSampler->sample(*shape, u);
    point.face.shape = primitive;
    return point;
}

float AreaEmitter::cosCone() const {
    const Disk* disk = std::get_if<Disk>(shape);
    return disk ? disk->cosConeAngle : 0.0f;
}

float AreaEmitter::extent() const {
    return Pi * (1.0f - sqr(cosCone())) * areaSampler->area();
}

EmissionSample AreaEmitter::sampleEmission(const Vec2f& uPosition, const Vec2f& uDirection) const {
    const SurfaceSample start = samplePoint(uPosition);
    const float cone = cosCone();
    const Vec3f local = warp::squareToCosineCone(uDirection, cone);
    const Vec3f direction = Frame(start.normal).toWorld(local).normalized();
    const Rgb power = radiance.rgb(start.uv) * extent(); // L cos over the densities of position and direction
    return {start.spawnRay(direction), power, warp::squareToCosineConePdf(local, cone), start.normal};
}

Rgb AreaEmitter::emittedIntensity(const SurfaceSample& start, const Vec3f& direction) const {
    const float cosine = direction.dot(start.normal);
    if (!shinesAt(cosine)) return Rgb(0.0f);
    return radiance.rgb(start.uv) * (cosine * areaSampler->area());
}

float AreaEmitter::pdfEmissionDirection(const SurfaceSample& start, const Vec3f& direction) const {
    return warp::squareToCosineConePdf({0.0f, 0.0f, direction.dot(start.normal)}, cosCone());
}

MaybeDirect AreaEmitter::sampleDirect(const Vec3f& receiver, const Vec2f& u) const {
    const SurfaceSample point = samplePoint(u);
    const Vec3f offset = point.position - receiver;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return std::nullopt;
    const Vec3f direction = offset / distance;
    const float cosine = -direction.dot(point.normal);
    if (!shinesAt(cosine)) return std::nullopt;
    const float pdf = sqr(distance) / (cosine * areaSampler->area());
    return DirectSample{direction, distance, radiance.rgb(point.uv) / pdf, pdf, point.position, point.margin()};
}

float AreaEmitter::pdfDirect(const Vec3f& receiver, const Vec3f& position, const Vec3f& ng) const {
    const Vec3f offset = position - receiver;
    const float squared = offset.length2();
    const float cosine = -offset.dot(ng) / std::sqrt(squared);
    return cosine > 0.0f ? squared / (cosine * areaSampler->area()) : 0.0f;
}

Texture areaRadianceFromPower(const Texture& power, float area) {
    return power.scaled(Rgb(area > 0.0f ? 1.0f / (Pi * area) : 0.0f));
}

std::optional<Texture> AreaEmitter::readRadiance(const ModelReader& fields, const Shape& shape) {
    Texture radiance = fields.texture("emission", Texture(0.0f), {"radiance", "emitted to the side of the normal"},
                                      Range::nonNegative());
    const Texture power = fields.texture("power", Texture(0.0f), EmitterReader::PowerMeaning, Range::nonNegative());
    if (fields.has("power")) radiance = areaRadianceFromPower(power, surfaceArea(shape));
    if (maxComponent(radiance.maximum()) <= 0.0f) return std::nullopt;
    return radiance;
}

} // namespace tungsten
