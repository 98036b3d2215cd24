#pragma once
// Images over the surface.

#include "tungsten/core/LoadWatch.h"
#include "tungsten/texture/TextureModel.h"

#include <cstdint>
#include <filesystem>
#include <memory>
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

struct BitmapTexture {
    static constexpr const char* Type = "bitmap";
    static constexpr bool Constant = false;
    std::shared_ptr<const Bitmap> bitmap;

    static Texture read(const ModelReader& fields, const Texture& fallback, Range range);
    [[nodiscard]] Rgb rgb(const Vec2f& uv) const { return bitmap->rgb(uv); }
    [[nodiscard]] float scalar(const Vec2f& uv, const Rgb& factor) const {
        return bitmap->scalar(uv) * meanComponent(factor);
    }
    [[nodiscard]] float alpha(const Vec2f& uv, const Rgb&) const { return bitmap->alpha(uv); }
    [[nodiscard]] Vec2f derivatives(const Vec2f& uv, const Rgb& factor) const;
    [[nodiscard]] Rgb maximum() const { return bitmap->maximum(); }
    [[nodiscard]] Rgb average() const { return bitmap->average(); }
};

} // namespace tungsten
