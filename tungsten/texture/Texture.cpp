#include "tungsten/texture/Texture.h"

namespace tungsten {

const Rgb& CheckerTexture::rgb(const Vec2f& uv) const {
    const auto isOdd = [](float coordinate, int count) {
        return std::fmod(std::floor(coordinate * float(count)), 2.0f) != 0.0f;
    };
    return isOdd(uv.x, resU) != isOdd(uv.y, resV) ? onColor : offColor;
}

Rgb CheckerTexture::maximum() const {
    const auto larger = [&](int c) { return std::max(onColor[c], offColor[c]); };
    return {larger(0), larger(1), larger(2)};
}

Rgb CheckerTexture::average() const {
    // Cells are on where column + row is odd: half of them, rounded down.
    const int64_t cells = int64_t(resU) * resV, lit = cells / 2;
    const float on = cells > 0 ? float(double(lit) / double(cells)) : 0.0f;
    return onColor * on + offColor * (1.0f - on);
}

Vec2f BitmapTexture::derivatives(const Vec2f& uv, const Rgb& factor) const {
    const Vec2f texel(1.0f / float(bitmap->width), 1.0f / float(bitmap->height));
    const auto at = [&](float du, float dv) { return scalar({uv.x + du, uv.y + dv}, factor); };
    return {at(texel.x, 0) - at(-texel.x, 0), at(0, texel.y) - at(0, -texel.y)};
}

float Texture::alpha(const Vec2f& uv) const {
    return std::visit([&](const auto& m) { return m.alpha(uv, factor); }, model);
}

bool Texture::isConstant() const {
    return std::visit([](const auto& m) { return m.Constant; }, model);
}

Rgb Texture::maximum() const {
    return std::visit([&](const auto& m) { return Rgb(m.maximum() * factor); }, model);
}

Rgb Texture::average() const {
    return std::visit([&](const auto& m) { return Rgb(m.average() * factor); }, model);
}

Texture Texture::scaled(const Rgb& by) const {
    Texture result = *this;
    result.factor = result.factor * by;
    return result;
}

Vec2f Texture::derivatives(const Vec2f& uv) const {
    return std::visit([&](const auto& m) { return m.derivatives(uv, factor); }, model);
}

} // namespace tungsten
