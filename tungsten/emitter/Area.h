#pragma once
// Surfaces that emit, on the side of their geometric normal.

#include "tungsten/emitter/EmitterModel.h"
#include "tungsten/texture/Texture.h"

#include <memory>

namespace tungsten {

class ModelReader;

struct AreaEmitter : EmitterBase {
    const Shape* shape = nullptr;
    uint32_t primitive = 0; ///< index in Scene::primitives
    Texture radiance;
    std::shared_ptr<const AreaSampler> areaSampler;

    /// Radiance of a surface with `emission` or `power` (power wins), or none if it is dark.
    static std::optional<Texture> readRadiance(const ModelReader& fields, const Shape& shape);
    [[nodiscard]] EmissionSample sampleEmission(const Vec2f& uPosition, const Vec2f& uDirection) const;
    [[nodiscard]] Rgb emittedIntensity(const SurfaceSample& start, const Vec3f& direction) const;
    [[nodiscard]] EmissionCone emissionCone(const SurfaceSample& start) const {
        return {start.normal, 1.0f - cosCone(), true};
    }
    [[nodiscard]] float pdfEmissionDirection(const SurfaceSample& start, const Vec3f& direction) const;
    [[nodiscard]] BoundingSphere boundingSphere() const { return tungsten::boundingSphere(*shape); }
    [[nodiscard]] MaybeDirect sampleDirect(const Vec3f& receiver, const Vec2f& u) const;
    [[nodiscard]] Rgb totalPower() const { return radiance.average() * extent(); }

    /// A point of it, uniform by area.
    [[nodiscard]] SurfaceSample samplePoint(const Vec2f& u) const;
    [[nodiscard]] float pdfDirect(const Vec3f& receiver, const Vec3f& position, const Vec3f& ng) const;
    [[nodiscard]] Rgb emittedRadiance(const Vec2f& uv, const Vec3f& ng, const Vec3f& towards) const {
        return shinesAt(ng.dot(towards)) ? radiance.rgb(uv) : Rgb(0.0f);
    }
    /// Cosine of the half angle of the cone about the normal that it shines into: 0 but for disks with a cone_angle.
    [[nodiscard]] float cosCone() const;
    [[nodiscard]] bool shinesAt(float cosine) const { return cosine > 0.0f && cosine >= cosCone(); }
    /// What its radiance is multiplied by for the power: area times projected solid angle.
    [[nodiscard]] float extent() const;
};

/// P / (pi A).
Texture areaRadianceFromPower(const Texture& power, float area);

} // namespace tungsten
