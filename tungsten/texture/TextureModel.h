#pragma once
// What a texture answers: a value over the surface, as a colour (albedo, emission) or as a scalar (roughness, ratio,
// alpha), before Texture's factor.

#include "tungsten/core/Types.h"
#include "tungsten/reader/Field.h"

#include <concepts>

namespace tungsten {

class ModelReader;
struct Texture;

template <typename M>
concept TextureModel = std::copyable<M> && requires(const M& m, const Vec2f& uv, const Rgb& factor) {
    { M::Type } -> std::convertible_to<std::string>; // of the scene file
    { &M::read } -> std::convertible_to<Texture (*)(const ModelReader&, const Texture& fallback, Range)>;
    { M::Constant } -> std::convertible_to<bool>;
    { m.rgb(uv) } -> std::convertible_to<Rgb>;
    { m.scalar(uv, factor) } -> std::same_as<float>;
    { m.alpha(uv, factor) } -> std::same_as<float>;       // the "auto" scalar of transparency
    { m.derivatives(uv, factor) } -> std::same_as<Vec2f>; // of the scalar between texels, for bumps
    { m.maximum() } -> std::convertible_to<Rgb>;
    { m.average() } -> std::convertible_to<Rgb>;
};

} // namespace tungsten
