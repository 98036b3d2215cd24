// Image files to bitmaps: LDR formats and Radiance through stb, PFM and OpenEXR through the film room's readers.

#include "tungsten/core/Errors.h"
#include "tungsten/core/FileBytes.h"
#include "tungsten/film/ImageIo.h"
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

constexpr int64_t MostTexels = int64_t(1) << 27;
/// No format packs more texels into a byte (a one-bit PNG of one colour reaches half of it).
constexpr int64_t MostTexelsPerByte = 1 << 14;

void requirePlausibleSize(int64_t width, int64_t height, size_t fileBytes, const std::filesystem::path& file) {
    const int64_t largest = std::min(MostTexels, int64_t(fileBytes) * MostTexelsPerByte);
    if (width <= 0 || height <= 0 || width > largest / height)
        throw InputError(file.string(), "claims to be " + std::to_string(width) + "x" + std::to_string(height) +
                                            " texels, more than a file of " + std::to_string(fileBytes) +
                                            " bytes can hold, or than the " + std::to_string(MostTexels) + " accepted");
}

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
        std::memset(out, 0, size_t(std::max(size, 0)));
        std::memcpy(out, bytes.data() + position, count);
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

void loadThroughStb(std::string_view bytes, const std::filesystem::path& file, Bitmap& bitmap) {
    const auto fail = [&](const std::string& why) -> InputError {
        return {file.string(), "not a readable image: " + why};
    };
    const auto reason = [] { return std::string(stbi_failure_reason() ? stbi_failure_reason() : "corrupt"); };
    const stbi_io_callbacks& callbacks = streamCallbacks();
    ByteStream header{bytes};
    if (!stbi_info_from_callbacks(&callbacks, &header, &bitmap.width, &bitmap.height, &bitmap.channels))
        throw fail(reason() + "; accepted: png, jpg, tga, bmp, gif, psd, hdr, pfm and exr");
    requirePlausibleSize(bitmap.width, bitmap.height, bytes.size(), file);
    const size_t texels = size_t(bitmap.width) * size_t(bitmap.height);
    ByteStream probe{bytes}, stream{bytes};
    int width = 0, height = 0, channels = 0;
    const auto requireComplete = [&](const void* pixels) {
        if (!pixels) throw fail(reason());
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

/// Walks over the attributes of an EXR file's headers: OpenEXR allocates what their sizes claim before it reads them.
void requireSaneExrAttributes(std::string_view bytes, const std::filesystem::path& file) {
    constexpr size_t HeaderStart = 8;
    const auto fail = [&]() -> InputError {
        return {file.string(), "not a readable EXR image: corrupt or truncated header"};
    };
    if (bytes.size() < HeaderStart) throw fail();
    const bool multiPart = (static_cast<unsigned char>(bytes[5]) & 0x10) != 0;
    size_t position = HeaderStart;
    const auto skipName = [&] {
        const size_t end = bytes.find('\0', position);
        if (end == std::string_view::npos) throw fail();
        const size_t length = end - position;
        position = end + 1;
        return length;
    };
    for (bool inHeaders = true; inHeaders;) {
        size_t attributes = 0;
        for (; skipName() > 0; ++attributes) {
            skipName(); // the type
            uint32_t size = 0;
            if (bytes.size() - position < sizeof(size)) throw fail();
            std::memcpy(&size, bytes.data() + position, sizeof(size));
            position += sizeof(size);
            if (size > bytes.size() - position) throw fail();
            position += size;
        }
        inHeaders = multiPart && attributes > 0; // an empty header ends the list of parts
    }
}

void requirePlausibleExr(std::string_view bytes, const std::filesystem::path& file) {
    requireSaneExrAttributes(bytes, file);
    try {
        const auto window = Imf::MultiPartInputFile(file.c_str()).header(0).dataWindow();
        requirePlausibleSize(int64_t(window.max.x) - window.min.x + 1, int64_t(window.max.y) - window.min.y + 1,
                             bytes.size(), file);
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

} // namespace

std::shared_ptr<Bitmap> loadBitmap(const std::filesystem::path& file) {
    const std::vector<char> content = readFileBytes(file);
    const std::string_view bytes(content.data(), content.size());
    auto bitmap = std::make_shared<Bitmap>();
    if (bytes.starts_with("version https://git-lfs.github.com/spec/")) {
        fillPlaceholder(*bitmap);
    } else if (bytes.starts_with("PF\n") || bytes.starts_with("Pf\n") || bytes.starts_with("PF\r") ||
               bytes.starts_with("Pf\r")) {
        copyImage(readPfm(file), *bitmap);
    } else if (bytes.starts_with("\x76\x2f\x31\x01")) {
        requirePlausibleExr(bytes, file);
        copyImage(readExr(file), *bitmap);
    } else {
        loadThroughStb(bytes, file, *bitmap);
    }
    // The decoders of the format always deliver alpha for these two.
    if (bytes.starts_with("\x89PNG") || bytes.starts_with("\xff\xd8")) bitmap->channels = 4;
    for (float& value : bitmap->hdr) value = finiteTexel(value);
    return bitmap;
}

} // namespace tungsten
