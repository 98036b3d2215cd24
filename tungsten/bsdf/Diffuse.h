#pragma once
// Lambert and Oren-Nayar.

#include "tungsten/bsdf/BsdfModel.h"

namespace tungsten {

struct Lambert : BsdfBase {
    static constexpr const char* Type = "lambert";

    static Lambert read(const BsdfReader&) { return {}; }
    [[nodiscard]] LobeMask lobes() const { return lobe::DiffuseReflection; }
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] bool isLambertian() const { return true; }
};

struct OrenNayar : BsdfBase {
    static constexpr const char* Type = "oren_nayar";
    Texture roughness{1.0f};

    static OrenNayar read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const { return lobe::DiffuseReflection; }
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] BsdfParts parts() const { return {{roughness}, {}}; }
};

} // namespace tungsten
