#pragma once
// Textures: the set of models, and one of them with a factor.

#include "tungsten/core/ModelSet.h"
#include "tungsten/texture/Bitmap.h"
#include "tungsten/texture/Checker.h"
#include "tungsten/texture/Constant.h"

namespace tungsten {

template <TextureModel M>
using CheckedTexture = M;
template <typename... M>
using TextureSet = ModelSet<CheckedTexture<M>...>;

using Textures = TextureSet<ConstantTexture, CheckerTexture, BitmapTexture>;

/// A value over the surface, by uv.
struct Texture {
    Textures::Variant model;
    Rgb factor{1.0f}; ///< multiplies the model

    Texture() = default;
    explicit Texture(const Rgb& constant) : model(ConstantTexture{constant}) {}
    explicit Texture(float constant) : model(ConstantTexture{Rgb(constant)}) {}
    explicit Texture(CheckerTexture checker) : model(checker) {}
    explicit Texture(std::shared_ptr<const Bitmap> bitmap) : model(BitmapTexture{std::move(bitmap)}) {}

    [[nodiscard]] Rgb rgb(const Vec2f& uv) const {
        return std::visit([&](const auto& m) { return Rgb(m.rgb(uv) * factor); }, model);
    }
    [[nodiscard]] float scalar(const Vec2f& uv) const {
        return std::visit([&](const auto& m) { return m.scalar(uv, factor); }, model);
    }
    /// The "auto" scalar of transparency: alpha where the file has four channels.
    [[nodiscard]] float alpha(const Vec2f& uv) const;
    [[nodiscard]] bool isConstant() const;
    [[nodiscard]] Rgb maximum() const;
    [[nodiscard]] Rgb average() const;
    /// Multiplied by a constant colour (power conversions).
    [[nodiscard]] Texture scaled(const Rgb& by) const;
    /// Bump: central texel differences (dh/du, dh/dv) of the scalar, as the format defines them; zero for constants.
    [[nodiscard]] Vec2f derivatives(const Vec2f& uv) const;
};

} // namespace tungsten
