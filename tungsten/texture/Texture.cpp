#include "tungsten/texture/Texture.h"

namespace tungsten {

namespace {

const Rgb& checkerColor(const CheckerTexture& checker, const Vec2f& uv) {
    const auto cell = [](float coordinate, int count) { return int64_t(std::floor(coordinate * float(count))); };
    const bool on = ((cell(uv.x, checker.resU) ^ cell(uv.y, checker.resV)) & 1) != 0;
    return on ? checker.onColor : checker.offColor;
}

} // namespace

Rgb Texture::lookupRgb(const Vec2f& uv) const {
    if (const auto* checker = std::get_if<CheckerTexture>(&model)) return checkerColor(*checker, uv) * factor;
    return std::get<BitmapTexture>(model).bitmap->rgb(uv) * factor;
}

float Texture::lookupScalar(const Vec2f& uv) const {
    if (const auto* checker = std::get_if<CheckerTexture>(&model)) return meanComponent(checkerColor(*checker, uv) * factor);
    return std::get<BitmapTexture>(model).bitmap->scalar(uv) * meanComponent(factor);
}

float Texture::alpha(const Vec2f& uv) const {
    if (const auto* bitmap = std::get_if<BitmapTexture>(&model)) return bitmap->bitmap->alpha(uv);
    return scalar(uv);
}

Rgb Texture::maximum() const {
    if (const auto* constant = std::get_if<ConstantTexture>(&model)) return constant->value;
    if (const auto* bitmap = std::get_if<BitmapTexture>(&model)) return bitmap->bitmap->maximum() * factor;
    const auto& checker = std::get<CheckerTexture>(model);
    const auto larger = [&](int c) { return std::max(checker.onColor[c], checker.offColor[c]) * factor[c]; };
    return {larger(0), larger(1), larger(2)};
}

Rgb Texture::average() const {
    if (const auto* constant = std::get_if<ConstantTexture>(&model)) return constant->value;
    if (const auto* bitmap = std::get_if<BitmapTexture>(&model)) return bitmap->bitmap->average() * factor;
    const auto& checker = std::get<CheckerTexture>(model);
    return (checker.onColor + checker.offColor) * 0.5f * factor;
}

Texture Texture::scaled(const Rgb& by) const {
    Texture result = *this;
    if (auto* constant = std::get_if<ConstantTexture>(&result.model))
        constant->value = constant->value * by;
    else
        result.factor = result.factor * by;
    return result;
}

Vec2f Texture::derivatives(const Vec2f& uv) const {
    const auto* bitmap = std::get_if<BitmapTexture>(&model);
    if (!bitmap) return {0.0f, 0.0f};
    const Vec2f texel(1.0f / float(bitmap->bitmap->width), 1.0f / float(bitmap->bitmap->height));
    const auto at = [&](float du, float dv) { return lookupScalar({uv.x + du, uv.y + dv}); };
    return {at(texel.x, 0) - at(-texel.x, 0), at(0, texel.y) - at(0, -texel.y)};
}

} // namespace tungsten
