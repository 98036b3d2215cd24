#pragma once
// Models that let light through or combine others: null, forward, transparency, mixed.

#include "tungsten/bsdf/BsdfModel.h"

namespace tungsten {

/// Black.
struct Null : SpecularBase {
    static constexpr const char* Type = "null";

    static Null read(const BsdfReader&) { return {}; }
    [[nodiscard]] LobeMask lobes() const { return lobe::None; }
    [[nodiscard]] MaybeSample sample(const ModelPoint&, const Vec3f&, const BsdfRandom&) const { return std::nullopt; }
};

struct Forward : SpecularBase {
    static constexpr const char* Type = "forward";

    static Forward read(const BsdfReader&) { return {}; }
    [[nodiscard]] LobeMask lobes() const { return lobe::Forward; }
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] Rgb forwardWeight(const ModelPoint&) const { return Rgb(1.0f); }
};

struct Transparency : BsdfBase {
    static constexpr const char* Type = "transparency";
    BsdfPtr base;
    Texture alpha{1.0f};

    static Transparency read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const;
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] Rgb forwardWeight(const ModelPoint& at) const;
    [[nodiscard]] bool isLambertian() const;
    [[nodiscard]] BsdfParts parts() const { return {{alpha}, {base}}; }
};

struct Mixed : BsdfBase {
    static constexpr const char* Type = "mixed";
    BsdfPtr bsdf0, bsdf1;
    Texture ratio{0.5f};

    static Mixed read(const BsdfReader& fields);
    [[nodiscard]] LobeMask lobes() const;
    [[nodiscard]] Rgb eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] float pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const;
    [[nodiscard]] MaybeSample sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const;
    [[nodiscard]] Rgb forwardWeight(const ModelPoint& at) const;
    [[nodiscard]] bool isLambertian() const;
    [[nodiscard]] BsdfParts parts() const { return {{ratio}, {bsdf0, bsdf1}}; }
};

} // namespace tungsten
