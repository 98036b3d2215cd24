#pragma once
// Squares of two colours.

#include "tungsten/texture/TextureModel.h"

namespace tungsten {

struct CheckerTexture {
    static constexpr const char* Type = "checker";
    static constexpr bool Constant = false;
    Rgb onColor{0.8f}, offColor{0.2f};
    int resU = 20, resV = 20;

    static Texture read(const ModelReader& fields, const Texture& fallback, Range range);
    [[nodiscard]] const Rgb& rgb(const Vec2f& uv) const;
    [[nodiscard]] float scalar(const Vec2f& uv, const Rgb& factor) const { return meanComponent(rgb(uv) * factor); }
    [[nodiscard]] float alpha(const Vec2f& uv, const Rgb& factor) const { return scalar(uv, factor); }
    /// The format has none.
    [[nodiscard]] Vec2f derivatives(const Vec2f&, const Rgb&) const { return {0.0f, 0.0f}; }
    [[nodiscard]] Rgb maximum() const;
    [[nodiscard]] Rgb average() const;
};

} // namespace tungsten
