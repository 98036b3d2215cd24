// Bitmaps and lookups in them, as the scene format defines them.

#include "tungsten/texture/ModelReader.h"

#include <array>

namespace tungsten {

namespace {

/// 8-bit colours are linearised to 8 bits again, by truncation: a rule of the format.
const std::array<float, 256>& linearised() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = float(std::floor(255.0 * std::pow(double(i) / 255.0, 2.2)) / 255.0);
        return values;
    }();
    return table;
}

int wrap(int i, int size, bool clamp) {
    if (clamp) return std::clamp(i, 0, size - 1);
    const int r = i % size;
    return r < 0 ? r + size : r;
}

/// Bilinear (texel centres at half integers) or nearest blend of fetch(column, row); row 0 is the top, v = 1.
template <typename Fetch>
auto blend(const Bitmap& bitmap, const Vec2f& uv, Fetch fetch) {
    // Repeating lookups are reduced first, so that far uv keep their digits; absurd ones land on texel 0.
    const auto reduce = [&](float c) {
        if (!std::isfinite(c)) return 0.0f;
        return bitmap.clamp ? std::clamp(c, 0.0f, 1.0f) : c - std::floor(c);
    };
    const float x = reduce(uv.x) * float(bitmap.width), y = (1.0f - reduce(uv.y)) * float(bitmap.height);
    const auto texel = [&](int column, int row) {
        return fetch(size_t(wrap(row, bitmap.height, bitmap.clamp)) * size_t(bitmap.width) +
                     size_t(wrap(column, bitmap.width, bitmap.clamp)));
    };
    if (!bitmap.interpolates()) return texel(int(x), int(y));
    const float fx = x - 0.5f, fy = y - 0.5f;
    const int column = int(std::floor(fx)), row = int(std::floor(fy));
    const float wx = fx - std::floor(fx), wy = fy - std::floor(fy);
    return (texel(column, row) * (1.0f - wx) + texel(column + 1, row) * wx) * (1.0f - wy) +
           (texel(column, row + 1) * (1.0f - wx) + texel(column + 1, row + 1) * wx) * wy;
}

Rgb texelRgb(const Bitmap& bitmap, size_t i) {
    if (!bitmap.hdr.empty()) return {bitmap.hdr[3 * i], bitmap.hdr[3 * i + 1], bitmap.hdr[3 * i + 2]};
    const uint8_t* texel = &bitmap.ldr[4 * i];
    if (bitmap.gammaCorrect) return {linearised()[texel[0]], linearised()[texel[1]], linearised()[texel[2]]};
    return Rgb(texel[0], texel[1], texel[2]) / 255.0f;
}

float texelScalar(const Bitmap& bitmap, size_t i) {
    if (!bitmap.hdr.empty()) return meanComponent(texelRgb(bitmap, i));
    const uint8_t* texel = &bitmap.ldr[4 * i];
    const int mean = (texel[0] + texel[1] + texel[2]) / 3;
    return float(mean) / 255.0f;
}

} // namespace

Rgb Bitmap::rgb(const Vec2f& uv) const {
    return blend(*this, uv, [this](size_t i) { return texelRgb(*this, i); }) * appliedScale();
}

float Bitmap::scalar(const Vec2f& uv) const {
    return blend(*this, uv, [this](size_t i) { return texelScalar(*this, i); }) * appliedScale();
}

float Bitmap::alpha(const Vec2f& uv) const {
    if (channels != 4 || ldr.empty()) return scalar(uv);
    return blend(*this, uv, [this](size_t i) { return float(ldr[4 * i + 3]) / 255.0f; }) * appliedScale();
}

Rgb Bitmap::maximum() const {
    Rgb largest(0.0f);
    for (size_t i = 0; i < size_t(width) * size_t(height); ++i) {
        const Rgb texel = texelRgb(*this, i);
        for (int c = 0; c < 3; ++c) largest[c] = std::max(largest[c], texel[c]);
    }
    return largest * appliedScale();
}

Rgb Bitmap::average() const {
    Imath::Color3<double> sum(0.0);
    const size_t texels = size_t(width) * size_t(height);
    for (size_t i = 0; i < texels; ++i) {
        const Rgb texel = texelRgb(*this, i);
        sum += Imath::Color3<double>(texel.x, texel.y, texel.z);
    }
    sum /= double(texels);
    return Rgb(float(sum.x), float(sum.y), float(sum.z)) * appliedScale();
}

Vec2f BitmapTexture::derivatives(const Vec2f& uv, const Rgb& factor) const {
    const Vec2f texel(1.0f / float(bitmap->width), 1.0f / float(bitmap->height));
    const auto at = [&](float du, float dv) { return scalar({uv.x + du, uv.y + dv}, factor); };
    return {at(texel.x, 0) - at(-texel.x, 0), at(0, texel.y) - at(0, -texel.y)};
}

Texture BitmapTexture::read(const ModelReader& fields, const Texture& fallback, Range range) {
    const std::string file = fields.text("file", "", {"none", "the image", "required"});
    Bitmap lookup;
    lookup.gammaCorrect = fields.flag("gamma_correct", true, {"none", "colours of 8-bit images are linearised"});
    lookup.interpolate = fields.flag("interpolate", true, {"none", "bilinear between texels"});
    lookup.clamp = fields.flag("clamp", false, {"none", "the edge goes on outside [0, 1], not the image again"});
    lookup.scale = float(fields.number("scale", 1.0, {"none", "factor on every value"}));
    if (!file.empty()) return fields.bitmap("file", file, lookup, range);
    fields.problem("file", "a bitmap needs the name of an image file");
    return fallback;
}

} // namespace tungsten
