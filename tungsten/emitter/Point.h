#pragma once
// Points that shine in every direction, or into a cone.

#include "tungsten/emitter/EmitterModel.h"

namespace tungsten {

/// Isotropic; intensity in W/sr.
struct PointEmitter : EmitterBase {
    static constexpr const char* Type = "point";
    Vec3f position;
    Rgb intensity{0.0f};

    static std::optional<PointEmitter> read(const EmitterReader& fields);
    [[nodiscard]] EmissionSample sampleEmission(const Vec2f& uPosition, const Vec2f& uDirection) const;
    [[nodiscard]] Rgb emittedIntensity(const SurfaceSample&, const Vec3f&) const { return intensity; }
    [[nodiscard]] EmissionCone emissionCone(const SurfaceSample&) const { return {}; }
    [[nodiscard]] float pdfEmissionDirection(const SurfaceSample& start, const Vec3f& direction) const;
    [[nodiscard]] std::optional<Rgb> isotropicIntensity() const { return intensity; }
    [[nodiscard]] BoundingSphere boundingSphere() const { return {position, 0.0f}; }
    [[nodiscard]] MaybeDirect sampleDirect(const Vec3f& receiver, const Vec2f& u) const;
    [[nodiscard]] Rgb totalPower() const { return intensity * (4.0f * Pi); }
};

/// Full intensity inside cosInner, smoothstep to zero at cosOuter.
struct SpotEmitter : EmitterBase {
    static constexpr const char* Type = "spot";
    Vec3f position, direction;
    Rgb intensity{0.0f}; ///< on the axis, W/sr
    float cosInner = 0.9f, cosOuter = 0.8f;

    static std::optional<SpotEmitter> read(const EmitterReader& fields);
    [[nodiscard]] EmissionSample sampleEmission(const Vec2f& uPosition, const Vec2f& uDirection) const;
    [[nodiscard]] Rgb emittedIntensity(const SurfaceSample& start, const Vec3f& towards) const;
    [[nodiscard]] EmissionCone emissionCone(const SurfaceSample&) const { return {direction, 1.0f - cosOuter, false}; }
    [[nodiscard]] float pdfEmissionDirection(const SurfaceSample& start, const Vec3f& towards) const;
    [[nodiscard]] BoundingSphere boundingSphere() const { return {position, 0.0f}; }
    [[nodiscard]] MaybeDirect sampleDirect(const Vec3f& receiver, const Vec2f& u) const;
    [[nodiscard]] Rgb totalPower() const { return intensity * solidAngle(); }

    [[nodiscard]] float falloff(float cosTheta) const;
    /// Towards a unit direction. By the difference from the axis: in a narrow cone a dot product's rounding is a large
    /// part of the edge.
    [[nodiscard]] float falloffTowards(const Vec3f& unit) const {
        return falloff(1.0f - 0.5f * (unit - direction).length2());
    }
    /// That, at full intensity, would carry the power of its cone with the smooth edge.
    [[nodiscard]] float solidAngle() const;
};

/// Intensity of a point of total power P: P / 4 pi.
Rgb pointIntensityFromPower(const Rgb& power);

} // namespace tungsten
