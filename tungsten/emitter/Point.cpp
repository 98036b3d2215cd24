#include "tungsten/emitter/Point.h"

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/EmitterReader.h"

namespace tungsten {

namespace {

/// Toward a point source: intensity / distance^2.
std::optional<DirectSample> connectToPoint(const Vec3f& position, const Vec3f& receiver) {
    const Vec3f offset = position - receiver;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return std::nullopt;
    return DirectSample{offset / distance, distance, Rgb(1.0f / sqr(distance)), 0.0f, position};
}

} // namespace

EmissionSample PointEmitter::sampleEmission(const Vec2f&, const Vec2f& uDirection) const {
    const Vec3f direction = warp::squareToSphere(uDirection);
    const float pdf = warp::squareToSpherePdf();
    return {{position, direction}, intensity / pdf, pdf, direction};
}

float PointEmitter::pdfEmissionDirection(const SurfaceSample&, const Vec3f&) const {
    return warp::squareToSpherePdf();
}

MaybeDirect PointEmitter::sampleDirect(const Vec3f& receiver, const Vec2f&) const {
    auto sample = connectToPoint(position, receiver);
    if (sample) sample->weight = sample->weight * intensity;
    return sample;
}

Rgb pointIntensityFromPower(const Rgb& power) {
    return power / (4.0f * Pi);
}

std::optional<PointEmitter> PointEmitter::read(const EmitterReader& fields) {
    const auto strength = fields.strength({"power/steradian", "intensity in every direction"});
    const Rgb intensity = strength.isPower ? pointIntensityFromPower(strength.value) : strength.value;
    if (!fields.shines(intensity)) return std::nullopt;
    return PointEmitter{{}, fields.placement.translation, intensity};
}

float SpotEmitter::falloff(float cosTheta) const {
    if (cosTheta <= cosOuter) return 0.0f;
    if (cosTheta >= cosInner) return 1.0f;
    const float x = (cosTheta - cosOuter) / (cosInner - cosOuter);
    return x * x * (3.0f - 2.0f * x);
}

float SpotEmitter::solidAngle() const {
    // The smoothstep is antisymmetric about the middle of the edge, so it averages to 1/2 over equal steps of the
    // cosine.
    return 2.0f * Pi * (1.0f - 0.5f * (cosInner + cosOuter));
}

EmissionSample SpotEmitter::sampleEmission(const Vec2f&, const Vec2f& uDirection) const {
    const Vec3f local = warp::squareToCone(uDirection, cosOuter);
    const Vec3f towards = Frame(direction).toWorld(local).normalized();
    const float pdf = warp::squareToConePdf(cosOuter);
    return {{position, towards}, intensity * (falloff(local.z) / pdf), pdf, towards};
}

Rgb SpotEmitter::emittedIntensity(const SurfaceSample&, const Vec3f& towards) const {
    return intensity * falloffTowards(towards);
}

float SpotEmitter::pdfEmissionDirection(const SurfaceSample&, const Vec3f& towards) const {
    return towards.dot(direction) >= cosOuter ? warp::squareToConePdf(cosOuter) : 0.0f;
}

MaybeDirect SpotEmitter::sampleDirect(const Vec3f& receiver, const Vec2f&) const {
    auto sample = connectToPoint(position, receiver);
    if (!sample) return sample;
    const float falloff = falloffTowards(-sample->direction);
    if (falloff <= 0.0f) return std::nullopt;
    sample->weight = sample->weight * intensity * falloff;
    return sample;
}

std::optional<SpotEmitter> SpotEmitter::read(const EmitterReader& fields) {
    const float halfAngle =
        float(fields.number("cone_angle", 30.0, {"degrees", "half angle of the cone of light along +z"}, {0.1, 180.0}));
    constexpr Meaning edgeMeaning{"degrees", "width of the cone's edge, across which light fades",
                                  "a tenth of cone_angle"};
    fields.declare("edge_angle", "a number from 0 to cone_angle", "", edgeMeaning);
    const float edge = float(fields.number("edge_angle", 0.1 * halfAngle, edgeMeaning, {0.0, halfAngle}));
    const float radians = Pi / 180.0f;
    SpotEmitter spot;
    spot.position = fields.placement.translation;
    spot.direction = fields.placement.rotation().n;
    spot.cosOuter = std::cos(halfAngle * radians);
    spot.cosInner = std::cos((halfAngle - edge) * radians);
    const auto strength = fields.strength({"power/steradian", "intensity on the axis"});
    spot.intensity = strength.isPower ? strength.value / spot.solidAngle() : strength.value;
    if (!fields.shines(spot.intensity)) return std::nullopt;
    return spot;
}

} // namespace tungsten
