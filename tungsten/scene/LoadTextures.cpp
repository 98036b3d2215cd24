#include "tungsten/reader/FormatTypes.h"
#include "tungsten/scene/LoadContext.h"

#include "tungsten/core/InsideFolder.h"

#include <algorithm>
#include <bit>

namespace tungsten {

namespace {

std::shared_ptr<const Bitmap> cachedBitmap(LoadContext& context, const std::string& file, bool gammaCorrect,
                                           bool interpolate, bool clamp, float scale) {
    const std::filesystem::path path = context.resource(file);
    const std::string key = path.string() + '\n' + (gammaCorrect ? 'g' : '-') + (interpolate ? 'i' : '-') +
                            (clamp ? 'c' : '-') + std::to_string(std::bit_cast<uint32_t>(scale));
    auto& entry = context.bitmaps[key];
    if (entry) return entry;
    context.watch.poll();
    const std::shared_ptr<Bitmap> bitmap = loadBitmap(path, context.watch);
    bitmap->gammaCorrect = gammaCorrect;
    bitmap->interpolate = interpolate;
    bitmap->clamp = clamp;
    bitmap->scale = scale;
    entry = bitmap;
    return entry;
}

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

Texture readBitmapFile(LoadContext& context, const ObjectReader& owner, const std::string& field,
                       const std::string& file, bool gammaCorrect, bool interpolate, bool clamp, float scale,
                       Range range) {
    try {
        const auto bitmap = cachedBitmap(context, file, gammaCorrect, interpolate, clamp, scale);
        if (bitmap->placeholder)
            owner.warn(field,
                       "'" + file + "' is a git-lfs placeholder: the picture was not fetched, a checker stands for it");
        const auto [low, high] = extremes(*bitmap);
        if (low < range.low || high > range.high)
            owner.problem(field, "expected " + describe(range) + " everywhere, found values from " + brief(low) +
                                     " to " + brief(high) + " in '" + file + "'" +
                                     (scale != 1.0f ? ", scale included" : ""));
        return Texture(bitmap);
    } catch (const InputError& error) {
        owner.problem(field, error.what());
        return Texture(0.5f);
    }
}

Texture readTextureObject(LoadContext& context, const ObjectReader& texture, const Texture& fallback, Range range) {
    const std::vector<std::string> types = textureTypes();
    const std::string type =
        texture.choice("type", "", types, {"none", "which texture", "required"}, unsupportedTextures());
    texture.accept({"name"});
    Texture result = fallback;
    if (type == "constant") {
        result = Texture(texture.rgb("value", Rgb(0.0f), {"none", "the same everywhere"}, range));
    } else if (type == "checker") {
        CheckerTexture checker;
        checker.onColor = texture.rgb("on_color", checker.onColor, {"none", "squares of one colour"}, range);
        checker.offColor = texture.rgb("off_color", checker.offColor, {"none", "squares of the other"}, range);
        checker.resU = int(texture.integer("res_u", checker.resU, {"none", "squares along u"}, {1, 1e9}));
        checker.resV = int(texture.integer("res_v", checker.resV, {"none", "squares along v"}, {1, 1e9}));
        result = Texture(checker);
    } else if (type == "bitmap") {
        const std::string file = texture.text("file", "", {"none", "the image", "required"});
        const bool gammaCorrect =
            texture.flag("gamma_correct", true, {"none", "colours of 8-bit images are linearised"});
        const bool interpolate = texture.flag("interpolate", true, {"none", "bilinear between texels"});
        const bool clamp =
            texture.flag("clamp", false, {"none", "the edge goes on outside [0, 1], not the image again"});
        const float scale = float(texture.number("scale", 1.0, {"none", "factor on every value"}));
        if (file.empty())
            texture.problem("file", "a bitmap needs the name of an image file");
        else
            result = readBitmapFile(context, texture, "file", file, gammaCorrect, interpolate, clamp, scale, range);
    } else if (!texture.has("type")) {
        texture.problem("type", "a texture object needs a type: " + listOf(types));
    }
    texture.warnAboutUnknown();
    return result;
}

std::string toText(const Texture& texture) {
    if (!texture.isConstant()) return "a texture";
    const Rgb value = texture.rgb({0.0f, 0.0f});
    return brief(double(value.x), double(value.y), double(value.z));
}

} // namespace

std::vector<std::string> textureTypes() {
    return {"bitmap", "checker", "constant"};
}

std::filesystem::path LoadContext::resource(const std::string& name) {
    const std::filesystem::path path = resourceDirectory / std::filesystem::path(name);
    if (!allowOutside && !isInside(path, resourceDirectory))
        throw InputError(path.string(), "lies outside the scene's folder (-i chooses another); if you trust the scene, "
                                        "--allow-outside lets it read any file");
    return path;
}

Texture readTexture(LoadContext& context, const ObjectReader& owner, const std::string& field, const Texture& fallback,
                    const Meaning& meaning, Range range) {
    if (owner.describes())
        owner.declare(field, describe(range) + ", an array of 3, an image file, or a texture", toText(fallback),
                      meaning);
    if (!owner.has(field)) return fallback;
    if (owner.isText(field))
        return readBitmapFile(context, owner, field, owner.text(field, "", meaning), true, true, false, 1.0f, range);
    if (owner.isObject(field)) return readTextureObject(context, *owner.object(field, meaning), fallback, range);
    return Texture(owner.rgb(field, Rgb(0.0f), meaning, range));
}

void describeTexture(const std::shared_ptr<Description>& description) {
    ScratchContext scratch;
    readTextureObject(scratch.context, ObjectReader::describing(description, description->name), Texture(0.0f), {});
}

Rgb readConstantTexture(LoadContext& context, const ObjectReader& owner, const std::string& field,
                        const Meaning& meaning) {
    owner.declare(field, describe(Range::nonNegative()) + ", or an array of 3", brief(0.0), meaning);
    const Texture texture = readTexture(context, owner, field, Texture(0.0f), meaning, Range::nonNegative());
    if (!texture.isConstant()) owner.problem(field, "this emitter takes a constant: a number or an array of 3");
    return texture.isConstant() ? texture.rgb({0.0f, 0.0f}) : Rgb(0.0f);
}

} // namespace tungsten
