#pragma once
// The same everywhere.

#include "tungsten/texture/TextureModel.h"

namespace tungsten {

struct ConstantTexture {
    static constexpr const char* Type = "constant";
    static constexpr bool Constant = true;
    Rgb value{0.0f};

    static Texture read(const ModelReader& fields, const Texture& fallback, Range range);
    [[nodiscard]] const Rgb& rgb(const Vec2f&) const { return value; }
    [[nodiscard]] float scalar(const Vec2f&, const Rgb& factor) const { return meanComponent(value * factor); }
    [[nodiscard]] float alpha(const Vec2f& uv, const Rgb& factor) const { return scalar(uv, factor); }
    [[nodiscard]] Vec2f derivatives(const Vec2f&, const Rgb&) const { return {0.0f, 0.0f}; }
    [[nodiscard]] const Rgb& maximum() const { return value; }
    [[nodiscard]] const Rgb& average() const { return value; }
};

} // namespace tungsten
