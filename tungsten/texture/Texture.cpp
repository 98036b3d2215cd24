#include "tungsten/texture/Texture.h"

namespace tungsten {

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
