#include "tungsten/texture/ModelReader.h"

#include "tungsten/reader/FormatTypes.h"

#include <algorithm>
#include <bit>

namespace tungsten {

namespace {

/// The least and the largest value of a bitmap, its scale included.
std::pair<double, double> extremes(const Bitmap& bitmap) {
    double low = 0.0, high = 1.0; // of 8-bit images
    if (!bitmap.hdr.empty()) {
        const auto [least, largest] = std::minmax_element(bitmap.hdr.begin(), bitmap.hdr.end());
        low = double(*least);
        high = double(*largest);
    }
    const double a = low * double(bitmap.appliedScale()), b = high * double(bitmap.appliedScale());
    return {std::min(a, b), std::max(a, b)};
}

std::string toText(const Texture& texture) {
    if (!texture.isConstant()) return "a texture";
    const Rgb value = texture.rgb({0.0f, 0.0f});
    return brief(double(value.x), double(value.y), double(value.z));
}

} // namespace

std::shared_ptr<const Bitmap> ModelReader::cachedBitmap(const std::string& file, const Bitmap& lookup) const {
    const std::filesystem::path path = files_->find(file);
    const std::string key = path.string() + '\n' + (lookup.gammaCorrect ? 'g' : '-') +
                            (lookup.interpolate ? 'i' : '-') + (lookup.clamp ? 'c' : '-') +
                            std::to_string(std::bit_cast<uint32_t>(lookup.scale));
    auto& entry = (*bitmaps_)[key];
    if (entry) return entry;
    files_->watch.poll();
    const std::shared_ptr<Bitmap> bitmap = loadBitmap(path, files_->watch);
    bitmap->gammaCorrect = lookup.gammaCorrect;
    bitmap->interpolate = lookup.interpolate;
    bitmap->clamp = lookup.clamp;
    bitmap->scale = lookup.scale;
    entry = bitmap;
    return entry;
}

Texture ModelReader::bitmap(const std::string& field, const std::string& file, const Bitmap& lookup,
                            Range range) const {
    try {
        const auto bitmap = cachedBitmap(file, lookup);
        if (bitmap->placeholder)
            warn(field,
                 "'" + file + "' is a git-lfs placeholder: the picture was not fetched, a checker stands for it");
        const auto [low, high] = extremes(*bitmap);
        if (low < range.low || high > range.high)
            problem(field, "expected " + describe(range) + " everywhere, found values from " + brief(low) + " to " +
                               brief(high) + " in '" + file + "'" + (lookup.scale != 1.0f ? ", scale included" : ""));
        return Texture(bitmap);
    } catch (const InputError& error) {
        problem(field, error.what());
        return Texture(0.5f);
    }
}

Texture ModelReader::asTexture(const Texture& fallback, Range range) const {
    const std::vector<std::string> types = Textures::types();
    const std::string type = choice("type", "", types, {"none", "which texture", "required"}, unsupportedTextures());
    accept({"name"});
    Texture result = fallback;
    if (Textures::has(type))
        result = Textures::read(type, [&]<typename Model> { return Model::read(*this, fallback, range); });
    else if (!has("type"))
        problem("type", "a texture object needs a type: " + listOf(types));
    warnAboutUnknown();
    return result;
}

Texture ModelReader::texture(const std::string& field, const Texture& fallback, const Meaning& meaning,
                             Range range) const {
    if (describes())
        declare(field, describe(range) + ", an array of 3, an image file, or a texture", toText(fallback), meaning);
    if (!has(field)) return fallback;
    if (isText(field)) return bitmap(field, text(field, "", meaning), Bitmap(), range);
    if (isObject(field)) return of(*object(field, meaning)).asTexture(fallback, range);
    return Texture(rgb(field, Rgb(0.0f), meaning, range));
}

Rgb ModelReader::constantTexture(const std::string& field, const Meaning& meaning) const {
    declare(field, describe(Range::nonNegative()) + ", or an array of 3", brief(0.0), meaning);
    const Texture read = texture(field, Texture(0.0f), meaning, Range::nonNegative());
    if (!read.isConstant()) problem(field, "this emitter takes a constant: a number or an array of 3");
    return read.isConstant() ? read.rgb({0.0f, 0.0f}) : Rgb(0.0f);
}

void describeTexture(const std::shared_ptr<Description>& description) {
    const Resources none;
    Bitmaps bitmaps;
    (void)ModelReader(ObjectReader::describing(description, description->name), none, bitmaps)
        .asTexture(Texture(0.0f), {});
}

} // namespace tungsten
