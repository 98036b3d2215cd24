#pragma once
// Textures: constant, checker, bitmap. A texture is fetched as a colour (albedo, emission) or as a scalar (roughness,
// ratio, alpha).

#include "tungsten/core/LoadWatch.h"
#include "tungsten/core/Types.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <variant>
#include <vector>

namespace tungsten {

/// Decoded image in texture space: row 0 is the top edge (v = 1). LDR files keep their 8-bit texels, HDR ones are
/// floats.
class Bitmap {
  public:
    int width = 0, height = 0;
    int channels = 0;         ///< channels reported by the decoder (1..4)
    std::vector<uint8_t> ldr; ///< RGBA8, colour NOT linearised; empty for HDR files
    std::vector<float> hdr;   ///< RGB float; empty for LDR files
    bool gammaCorrect = true; ///< LDR colour fetches: i -> floor(255 (i/255)^2.2)
    bool interpolate = true;
    bool clamp = false;
    float scale = 1.0f;
    /// The file was only a Git LFS pointer; these are the texels the format shows for an image that cannot be loaded:
    /// 2x2, black and white, never interpolated. Callers warn about it.
    bool placeholder = false;

    [[nodiscard]] bool interpolates() const { return interpolate && !placeholder; }
    /// The format leaves out the scale of nearest-texel lookups.
    [[nodiscard]] float appliedScale() const { return interpolates() ? scale : 1.0f; }
    [[nodiscard]] Rgb rgb(const Vec2f& uv) const;
    /// Mean of R, G, B without gamma.
    [[nodiscard]] float scalar(const Vec2f& uv) const;
    /// Alpha where the decoder reports four channels (PNG and JPEG always do), else the mean.
    [[nodiscard]] float alpha(const Vec2f& uv) const;
    [[nodiscard]] Rgb maximum() const;
    [[nodiscard]] Rgb average() const;
};

/// Reads png, jpg, tga, bmp, gif, psd, hdr (stb), pfm, exr, told apart by their content. Throws InputError for a
/// missing, corrupt or truncated file, or one whose size is absurd. Infinite HDR values become the largest half float,
/// NaN becomes 0.
std::shared_ptr<Bitmap> loadBitmap(const std::filesystem::path& file, const LoadWatch& watch = {});

// Models answer what Texture asks, before its factor.

struct ConstantTexture {
    Rgb value{0.0f};

    [[nodiscard]] const Rgb& rgb(const Vec2f&) const { return value; }
    [[nodiscard]] float scalar(const Vec2f&, const Rgb& factor) const { return meanComponent(value * factor); }
    [[nodiscard]] float alpha(const Vec2f& uv, const Rgb& factor) const { return scalar(uv, factor); }
    [[nodiscard]] Vec2f derivatives(const Vec2f&, const Rgb&) const { return {0.0f, 0.0f}; }
    [[nodiscard]] const Rgb& maximum() const { return value; }
    [[nodiscard]] const Rgb& average() const { return value; }
    static constexpr bool Constant = true;
};
struct CheckerTexture {
    Rgb onColor{0.8f}, offColor{0.2f};
    int resU = 20, resV = 20;

    [[nodiscard]] const Rgb& rgb(const Vec2f& uv) const;
    [[nodiscard]] float scalar(const Vec2f& uv, const Rgb& factor) const { return meanComponent(rgb(uv) * factor); }
    [[nodiscard]] float alpha(const Vec2f& uv, const Rgb& factor) const { return scalar(uv, factor); }
    /// The format has none.
    [[nodiscard]] Vec2f derivatives(const Vec2f&, const Rgb&) const { return {0.0f, 0.0f}; }
    [[nodiscard]] Rgb maximum() const;
    [[nodiscard]] Rgb average() const;
    static constexpr bool Constant = false;
};
struct BitmapTexture {
    std::shared_ptr<const Bitmap> bitmap;

    [[nodiscard]] Rgb rgb(const Vec2f& uv) const { return bitmap->rgb(uv); }
    [[nodiscard]] float scalar(const Vec2f& uv, const Rgb& factor) const {
        return bitmap->scalar(uv) * meanComponent(factor);
    }
    [[nodiscard]] float alpha(const Vec2f& uv, const Rgb&) const { return bitmap->alpha(uv); }
    [[nodiscard]] Vec2f derivatives(const Vec2f& uv, const Rgb& factor) const;
    [[nodiscard]] Rgb maximum() const { return bitmap->maximum(); }
    [[nodiscard]] Rgb average() const { return bitmap->average(); }
    static constexpr bool Constant = false;
};

/// A value over the surface, by uv.
struct Texture {
    std::variant<ConstantTexture, CheckerTexture, BitmapTexture> model;
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
