#pragma once
// A diffuse base under a dielectric coat: smooth, rough, and the sum of lobes that pbrt-v3 calls plastic.

#include "tungsten/bsdf/Microfacet.h"

namespace tungsten {

struct Plastic : BsdfBase {
    static constexpr const char* Type = "plastic";
    float ior = 1.5f;
    float thickness = 1.0f;
    Rgb sigmaA{0.0f};
    float diffuseFresnel = 0.0f; ///< 2 ∫ F(ior, c) c dc; set by makePlastic

    static Plastic read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const { return lobe::SpecularReflection | lobe::DiffuseReflection; }
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;

  private:
    [[nodiscard]] float mirrorProbability(const ModelPoint& at, const Vec3f& wi) const;
};

struct RoughPlastic : BsdfBase {
    static constexpr const char* Type = "rough_plastic";
    float ior = 1.5f;
    float thickness = 1.0f;
    Rgb sigmaA{0.0f};
    MicrofacetModel distribution = MicrofacetModel::Ggx;
    Texture roughness{0.02f};
    Rgb ks{1.0f};
    float diffuseFresnel = 0.0f; ///< set by makeRoughPlastic

    static RoughPlastic read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const { return lobe::GlossyReflection | lobe::DiffuseReflection; }
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] BsdfParts parts() const { return {{roughness}, {}}; }
};

/// The coat's Fresnel term is taken from the inside (eta = ior), as pbrt-v3's plastic does: it is 1 beyond the critical
/// angle.
struct PbrtPlastic : BsdfBase {
    static constexpr const char* Type = "pbrt_plastic";
    float ior = 1.5f;
    MicrofacetModel distribution = MicrofacetModel::PbrtGgx;
    Texture roughness{0.1f};
    Rgb ks{0.25f};

    static PbrtPlastic read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const { return lobe::GlossyReflection | lobe::DiffuseReflection; }
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] BsdfParts parts() const { return {{roughness}, {}}; }
};

Plastic makePlastic(float ior, float thickness, const Rgb& sigmaA);
RoughPlastic makeRoughPlastic(float ior, float thickness, const Rgb& sigmaA, MicrofacetModel distribution,
                              Texture roughness, const Rgb& ks);

} // namespace tungsten
