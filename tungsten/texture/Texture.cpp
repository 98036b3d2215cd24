#include "tungsten/texture/Texture.h"

namespace tungsten {

namespace {

const Rgb& checkerColor(const CheckerTexture& checker, const Vec2f& uv) {
    const auto isOdd = [](float coordinate, int count) {
        return std::fmod(std::floor(coordinate * float(count)), 2.0f) != 0.0f;
    };
    return isOdd(uv.x, checker.resU) != isOdd(uv.y, checker.resV) ? checker.onColor : checker.offColor;
}

} // namespace

Rgb Texture::lookupRgb(const Vec2f& uv) const {
    if (const auto* checker = std::get_if<CheckerTexture>(&model)) return checkerColor(*checker, uv) * factor;
    return std::get<BitmapTexture>(model).bitmap->rgb(uv) * factor;
}

float Texture::lookupScalar(const Vec2f& uv) const {
    if (const auto* checker = std::get_if<CheckerTexture>(&model))
        return meanComponent(checkerColor(*checker, uv) * factor);
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
    // Cells are on where column + row is odd: half of them, rounded down.
    const int64_t cells = int64_t(checker.resU) * checker.resV;
    const float on = cells > 0 ? float(double(cells / 2) / double(cells)) : 0.0f;
    return (checker.onColor * on + checker.offColor * (1.0f - on)) * factor;
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
