#pragma once
// Smooth and rough dielectric interfaces (Walter et al. 2007).

#include "tungsten/bsdf/Microfacet.h"

#include <variant>

namespace tungsten {

struct Dielectric : SpecularBase {
    static constexpr const char* Type = "dielectric";
    float ior = 1.5f;
    bool enableRefraction = true;

    static Dielectric read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const { return enableRefraction ? lobe::Specular : lobe::SpecularReflection; }
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] float relativeIndex() const { return ior; }
};

struct RoughDielectric : BsdfBase {
    static constexpr const char* Type = "rough_dielectric";
    float ior = 1.5f;
    MicrofacetModel distribution = MicrofacetModel::Ggx;
    Texture roughness{0.1f};
    bool enableRefraction = true;

    static std::variant<RoughDielectric, Dielectric> read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const {
        return lobe::GlossyReflection | (enableRefraction ? lobe::GlossyTransmission : lobe::None);
    }
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] float relativeIndex() const { return ior; }
    [[nodiscard]] BsdfParts parts() const { return {{roughness}, {}}; }
};

} // namespace tungsten
