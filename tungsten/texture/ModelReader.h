#pragma once
// How a model reads itself: the fields of its object, textures among them.

#include "tungsten/reader/ObjectReader.h"
#include "tungsten/reader/Resources.h"
#include "tungsten/texture/Texture.h"

#include <map>

namespace tungsten {

/// Images that textures name, each read once; by file and lookup settings.
using Bitmaps = std::map<std::string, std::shared_ptr<const Bitmap>>;

class ModelReader : public ObjectReader {
  public:
    ModelReader(const ObjectReader& object, const Resources& files, Bitmaps& bitmaps)
        : ObjectReader(object), files_(&files), bitmaps_(&bitmaps) {}

    /// A number or RGB (constant), a path (bitmap), or an object. Constant values must lie in `range`.
    [[nodiscard]] Texture texture(const std::string& field, const Texture& fallback, const Meaning& meaning,
                                  Range range = {}) const;
    /// One colour out of a texture field that may not vary.
    [[nodiscard]] Rgb constantTexture(const std::string& field, const Meaning& meaning) const;
    /// The image of a file, looked up as `lookup` says.
    [[nodiscard]] Texture bitmap(const std::string& field, const std::string& file, const Bitmap& lookup,
                                 Range range) const;
    /// The object itself.
    [[nodiscard]] Texture asTexture(const Texture& fallback, Range range) const;

  protected:
    [[nodiscard]] ModelReader of(const ObjectReader& object) const { return {object, *files_, *bitmaps_}; }

  private:
    [[nodiscard]] std::shared_ptr<const Bitmap> cachedBitmap(const std::string& file, const Bitmap& lookup) const;

    const Resources* files_;
    Bitmaps* bitmaps_;
};

/// Describes the fields of one type, as the functions of this name for other kinds do.
void describeTexture(const std::shared_ptr<Description>& description);

} // namespace tungsten
