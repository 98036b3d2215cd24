#pragma once
// Mirrors and metals, smooth and rough; named metals.

#include "tungsten/bsdf/Microfacet.h"

namespace tungsten {

struct Mirror : SpecularBase {
    static constexpr const char* Type = "mirror";

    static Mirror read(const BsdfReader&) { return {}; }
    [[nodiscard]] LobeMask lobes() const { return lobe::SpecularReflection; }
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
};

struct Conductor : SpecularBase {
    static constexpr const char* Type = "conductor";
    Rgb eta, k;

    static Conductor read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const { return lobe::SpecularReflection; }
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
};

struct RoughConductor : BsdfBase {
    static constexpr const char* Type = "rough_conductor";
    Rgb eta, k;
    MicrofacetModel distribution = MicrofacetModel::Ggx;
    Texture roughness{0.1f};

    static RoughConductor read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const { return lobe::GlossyReflection; }
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] BsdfParts parts() const { return {{roughness}, {}}; }
};

/// eta and k of the format's named metals; none for an unknown name.
std::optional<std::pair<Rgb, Rgb>> conductorByName(const std::string& name);
std::vector<std::string> conductorNames();

} // namespace tungsten
