// Image files to bitmaps: LDR formats and Radiance through stb, PFM and OpenEXR through the film room's readers.

#include "tungsten/core/Errors.h"
#include "tungsten/core/FileBytes.h"
#include "tungsten/image/ReadImage.h"
#include "tungsten/texture/ImageGuards.h"
#include "tungsten/texture/Texture.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_NO_PIC
#define STBI_NO_PNM
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>

#include <cstring>
#include <string_view>

namespace tungsten {

namespace {

/// Keeps sums and squares of texels finite.
float finiteTexel(float value) {
    constexpr float LargestHalf = 65504.0f, LargestTexel = 1e18f;
    if (std::isnan(value)) return 0.0f;
    if (std::isinf(value)) return std::copysign(LargestHalf, value);
    return std::clamp(value, -LargestTexel, LargestTexel);
}

/// Bytes for stb. Remembers whether the decoder wanted more than there are: stb itself accepts many truncated files.
struct ByteStream {
    std::string_view bytes;
    size_t position = 0;
    bool ranOut = false;

    int read(char* out, int size) {
        constexpr int RefillSize = 128; // stb's buffer: a refill may come back short at the end of a good file
        const size_t count = std::min(size_t(std::max(size, 0)), bytes.size() - position);
        if (count == 0 || (int(count) < size && size != RefillSize)) ranOut = true;
        std::fill_n(out, std::max(size, 0), '\0');
        std::copy_n(bytes.begin() + std::ptrdiff_t(position), count, out);
        position += count;
        return int(count);
    }
    void skip(int count) {
        if (count < 0)
            position -= std::min(position, size_t(-int64_t(count)));
        else
            position += std::min(bytes.size() - position, size_t(count));
    }
};

const stbi_io_callbacks& streamCallbacks() {
    static const stbi_io_callbacks callbacks{
        [](void* stream, char* out, int size) { return static_cast<ByteStream*>(stream)->read(out, size); },
        [](void* stream, int count) { static_cast<ByteStream*>(stream)->skip(count); },
        [](void* stream) {
            const auto* bytes = static_cast<const ByteStream*>(stream);
            return int(bytes->position >= bytes->bytes.size());
        }};
    return callbacks;
}

std::string whyStbFailed() {
    return stbi_failure_reason() ? stbi_failure_reason() : "corrupt";
}

InputError notReadable(const std::filesystem::path& file) {
    return {file.string(),
            "not a readable image: " + whyStbFailed() + "; accepted: png, jpg, tga, bmp, gif, psd, hdr, pfm and exr"};
}

void loadThroughStb(std::string_view bytes, const std::filesystem::path& file, Bitmap& bitmap) {
    const auto fail = [&](const std::string& why) -> InputError {
        return {file.string(), "not a readable image: " + why};
    };
    const stbi_io_callbacks& callbacks = streamCallbacks();
    if (isPng(bytes)) requireSanePngChunks(bytes, file);
    if (isJpeg(bytes)) requireSaneJpegTables(bytes, file);
    ByteStream header{bytes};
    if (!stbi_info_from_callbacks(&callbacks, &header, &bitmap.width, &bitmap.height, &bitmap.channels))
        throw notReadable(file);
    requirePlausibleSize(bitmap.width, bitmap.height, bytes, file);
    if (isRadiance(bytes)) requireSaneRadianceRuns(bytes, bitmap.width, bitmap.height, file);
    const size_t texels = size_t(bitmap.width) * size_t(bitmap.height);
    ByteStream probe{bytes}, stream{bytes};
    int width = 0, height = 0, channels = 0;
    const auto requireComplete = [&](const void* pixels) {
        if (!pixels) throw fail(whyStbFailed());
        if (stream.ranOut || width != bitmap.width || height != bitmap.height) throw fail("truncated");
    };
    if (stbi_is_hdr_from_callbacks(&callbacks, &probe)) {
        const std::unique_ptr<float, void (*)(void*)> pixels(
            stbi_loadf_from_callbacks(&callbacks, &stream, &width, &height, &channels, 3), stbi_image_free);
        requireComplete(pixels.get());
        bitmap.hdr.assign(pixels.get(), pixels.get() + 3 * texels);
    } else {
        const std::unique_ptr<uint8_t, void (*)(void*)> pixels(
            stbi_load_from_callbacks(&callbacks, &stream, &width, &height, &channels, 4), stbi_image_free);
        requireComplete(pixels.get());
        bitmap.ldr.assign(pixels.get(), pixels.get() + 4 * texels);
    }
}

void requirePlausibleExr(std::string_view bytes, const std::filesystem::path& file) {
    requireSaneExrAttributes(bytes, file);
    try {
        const auto window = Imf::MultiPartInputFile(file.c_str()).header(0).dataWindow();
        requirePlausibleSize(int64_t(window.max.x) - window.min.x + 1, int64_t(window.max.y) - window.min.y + 1, bytes,
                             file);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(file.string(), std::string("not a readable EXR image: ") + error.what());
    }
}

void copyImage(const Image& image, Bitmap& bitmap) {
    bitmap.width = image.width;
    bitmap.height = image.height;
    bitmap.channels = 3;
    bitmap.hdr.reserve(image.pixels.size() * 3);
    for (const Rgb& pixel : image.pixels) bitmap.hdr.insert(bitmap.hdr.end(), {pixel.x, pixel.y, pixel.z});
}

/// What the format shows where an image cannot be loaded.
void fillPlaceholder(Bitmap& bitmap) {
    bitmap.placeholder = true;
    bitmap.width = bitmap.height = 2;
    bitmap.channels = 3;
    bitmap.ldr = {0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255};
}

bool isPlaceholder(std::string_view bytes) {
    return bytes.starts_with("version https://git-lfs.github.com/spec/");
}

bool isPfm(std::string_view bytes) {
    return bytes.starts_with("PF\n") || bytes.starts_with("Pf\n") || bytes.starts_with("PF\r") ||
           bytes.starts_with("Pf\r");
}

bool isExr(std::string_view bytes) {
    return bytes.starts_with("\x76\x2f\x31\x01");
}

/// By its start; images of the other types tell their sizes there, too.
void requireImage(const std::filesystem::path& file, std::string_view start, uint64_t size) {
    constexpr uint64_t LargestImage = uint64_t(1) << 31; // of the most texels that are read, four floats each
    if (size > LargestImage) throw InputError(file.string(), "larger than 2 GiB: more than the largest image has");
    if (isPlaceholder(start) || isPfm(start) || isExr(start) || isPng(start) || isJpeg(start) || isRadiance(start))
        return;
    ByteStream header{start};
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_callbacks(&streamCallbacks(), &header, &width, &height, &channels)) throw notReadable(file);
}

} // namespace

std::shared_ptr<Bitmap> loadBitmap(const std::filesystem::path& file, const LoadWatch& watch) {
    const std::vector<char> content =
        readFileBytes(file, watch, [&](std::string_view start, uint64_t size) { requireImage(file, start, size); });
    const std::string_view bytes(content.data(), content.size());
    auto bitmap = std::make_shared<Bitmap>();
    if (isPlaceholder(bytes)) {
        fillPlaceholder(*bitmap);
    } else if (isPfm(bytes)) {
        copyImage(readPfm(file), *bitmap);
    } else if (isExr(bytes)) {
        requirePlausibleExr(bytes, file);
        copyImage(readExr(file), *bitmap);
    } else {
        loadThroughStb(bytes, file, *bitmap);
    }
    // The decoders of the format always deliver alpha for these two.
    if (isPng(bytes) || isJpeg(bytes)) bitmap->channels = 4;
    for (float& value : bitmap->hdr) value = finiteTexel(value);
    return bitmap;
}

} // namespace tungsten
