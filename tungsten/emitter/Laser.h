#pragma once
// Lasers: light of a single direction, which nothing can be connected to.

#include "tungsten/emitter/EmitterModel.h"

namespace tungsten {

struct LaserBase : EmitterBase {
    [[nodiscard]] bool isDelta() const { return true; }
    [[nodiscard]] bool isConnectable() const { return false; }
    [[nodiscard]] Rgb emittedIntensity(const SurfaceSample&, const Vec3f&) const { return Rgb(0.0f); }
    [[nodiscard]] float pdfEmissionDirection(const SurfaceSample&, const Vec3f&) const { return 0.0f; }
    [[nodiscard]] MaybeDirect sampleDirect(const Vec3f&, const Vec2f&) const { return std::nullopt; }
};

/// Carries `power` from a point.
struct DirectionalPointEmitter : LaserBase {
    static constexpr const char* Type = "directional_point";
    Vec3f position, direction;
    Rgb power{0.0f};

    static std::optional<DirectionalPointEmitter> read(const EmitterReader& fields);
    [[nodiscard]] EmissionSample sampleEmission(const Vec2f& uPosition, const Vec2f& uDirection) const;
    [[nodiscard]] EmissionCone emissionCone(const SurfaceSample&) const { return {direction, 0.0f, false}; }
    [[nodiscard]] BoundingSphere boundingSphere() const { return {position, 0.0f}; }
    [[nodiscard]] Rgb totalPower() const { return power; }
};

/// A wide laser: parallel light from a disc of `radius` (0: a line), carries `power`.
struct CollimatedEmitter : LaserBase {
    static constexpr const char* Type = "collimated";
    Vec3f position;
    Frame frame; ///< n is its direction
    float radius = 0.0f;
    Rgb power{0.0f};

    static std::optional<CollimatedEmitter> read(const EmitterReader& fields);
    [[nodiscard]] EmissionSample sampleEmission(const Vec2f& uPosition, const Vec2f& uDirection) const;
    [[nodiscard]] EmissionCone emissionCone(const SurfaceSample&) const { return {frame.n, 0.0f, false}; }
    [[nodiscard]] BoundingSphere boundingSphere() const { return {position, radius}; }
    [[nodiscard]] Rgb totalPower() const { return power; }
};

/// A directional_point with emission E carries 4 pi E.
Rgb directionalPointPower(const Rgb& emission);
/// A collimated laser's emission is its irradiance if it has a radius, else its power.
Rgb collimatedPowerFromEmission(const Rgb& emission, float radius);
/// The format divides a collimated laser's power by 4 pi on the way to its emission.
Rgb collimatedPowerFromPower(const Rgb& power, float radius);

} // namespace tungsten
