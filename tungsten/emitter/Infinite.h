#pragma once
// Environments: radiance from infinitely far away, constant or a bitmap. Steady state only.

#include "tungsten/emitter/EmitterModel.h"
#include "tungsten/texture/Texture.h"

#include <memory>

namespace tungsten {

struct InfiniteSphereEmitter : EmitterBase {
    static constexpr const char* Type = "infinite_sphere";
    Texture radiance;
    Frame frame; ///< rotation part of the transform
    bool samplable = true;
    std::shared_ptr<const Distribution2D> distribution; ///< over uv for bitmaps
    Vec3f sceneCentre{0, 0, 0};                         ///< set when the scene is complete, for photon emission
    float sceneRadius = 1.0f;

    static std::optional<InfiniteSphereEmitter> read(const EmitterReader& fields);
    [[nodiscard]] bool isInfinite() const { return true; }
    [[nodiscard]] bool isConnectable() const { return samplable; }
    [[nodiscard]] EmissionSample sampleEmission(const Vec2f& uPosition, const Vec2f& uDirection) const;
    /// An environment has no starting point common to all directions.
    [[nodiscard]] Rgb emittedIntensity(const SurfaceSample&, const Vec3f&) const { return Rgb(0.0f); }
    [[nodiscard]] EmissionCone emissionCone(const SurfaceSample&) const { return {}; }
    [[nodiscard]] float pdfEmissionDirection(const SurfaceSample& start, const Vec3f& direction) const;
    [[nodiscard]] BoundingSphere boundingSphere() const { return {sceneCentre, Infinity}; }
    [[nodiscard]] MaybeDirect sampleDirect(const Vec3f& receiver, const Vec2f& u) const;
    [[nodiscard]] Rgb totalPower() const { return radiance.average() * (4.0f * Pi * Pi * sqr(sceneRadius)); }
    [[nodiscard]] float pdfDirectInfinite(const Vec3f& direction) const { return samplable ? pdf(direction) : 0.0f; }
    [[nodiscard]] Rgb environmentRadiance(const Vec3f& direction) const;
    void encloseScene(const Vec3f& centre, float radius) {
        sceneCentre = centre;
        sceneRadius = radius;
    }

  private:
    [[nodiscard]] Vec2f uvOf(const Vec3f& direction) const;
    [[nodiscard]] Vec3f directionOf(const Vec2f& uv, float& sinTheta) const;
    /// Direction toward the sky and its density per solid angle.
    [[nodiscard]] Vec3f sample(const Vec2f& u, float& density) const;
    /// Of sample().
    [[nodiscard]] float pdf(const Vec3f& direction) const;
};

/// With its tables for sampling.
InfiniteSphereEmitter makeInfiniteSphere(const Texture& radiance, const Frame& frame, bool samplable);

} // namespace tungsten
