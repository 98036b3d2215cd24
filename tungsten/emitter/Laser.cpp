#include "tungsten/emitter/Laser.h"

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/EmitterReader.h"

namespace tungsten {

EmissionSample DirectionalPointEmitter::sampleEmission(const Vec2f&, const Vec2f&) const {
    return {{position, direction}, power, 0.0f, direction};
}

EmissionSample CollimatedEmitter::sampleEmission(const Vec2f& uPosition, const Vec2f&) const {
    const Vec2f disk = warp::squareToDisk(uPosition) * radius;
    const Vec3f origin = position + frame.s * disk.x + frame.t * disk.y;
    return {{origin, frame.n}, power, 0.0f, frame.n};
}

Rgb directionalPointPower(const Rgb& emission) {
    return emission * (4.0f * Pi);
}

Rgb collimatedPowerFromEmission(const Rgb& emission, float radius) {
    return radius > 0.0f ? emission * (Pi * radius * radius) : emission;
}

Rgb collimatedPowerFromPower(const Rgb& power, float radius) {
    return collimatedPowerFromEmission(power / (4.0f * Pi), radius);
}

std::optional<DirectionalPointEmitter> DirectionalPointEmitter::read(const EmitterReader& fields) {
    const auto strength =
        fields.strength({"power/steradian", "as if in every direction: all that is emitted, by 4 pi"});
    const Rgb power = strength.isPower ? strength.value : directionalPointPower(strength.value);
    if (!fields.shines(power)) return std::nullopt;
    return DirectionalPointEmitter{{}, fields.placement.translation, fields.placement.rotation().n, power};
}

std::optional<CollimatedEmitter> CollimatedEmitter::read(const EmitterReader& fields) {
    const float radius = float(fields.number(
        "radius", 0.0, {"length", "of the parallel light along +z; 0: a single ray"}, {0.0, Range::coordinate().high}));
    const auto strength = fields.strength({"power/length^2", "irradiance of the light; of a single ray its power"},
                                          {"power", "instead of `emission`, which is it divided by 4 pi", "none"});
    const Rgb power = strength.isPower ? collimatedPowerFromPower(strength.value, radius)
                                       : collimatedPowerFromEmission(strength.value, radius);
    if (!fields.shines(power)) return std::nullopt;
    return CollimatedEmitter{{}, fields.placement.translation, fields.placement.rotation(), radius, power};
}

} // namespace tungsten
