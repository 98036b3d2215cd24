// PNG, by stb.

#include "tungsten/io/Writers.h"

#include "tungsten/core/Errors.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/io/Format.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace tungsten {

void writePng(const std::filesystem::path& file, const Image& image, ToneMap toneMap) {
    const std::vector<uint8_t> bytes = toneMapped(image, toneMap);
    writeAtomically(file, [&](std::ostream& out) {
        const auto append = [](void* stream, void* data, int size) {
            static_cast<std::ostream*>(stream)->write(static_cast<const char*>(data), size);
        };
        if (!stbi_write_png_to_func(append, &out, image.width, image.height, 3, bytes.data(), image.width * 3))
            throw InputError(file.string(), "cannot be written: out of memory");
    });
}

extern const OutputFormat PngFormat{
    .extension = ".png", .uses = output_use::Shown, .write = [](const OutputFilm& film, const OutputImage& image) {
        if (image.linear) return writePng(image.file, film.whole(), ToneMap::Linear);
        writePng(image.file, image.frame ? film.shownFrame(*image.frame) : film.shownWhole(), film.scene().toneMap);
    }};

} // namespace tungsten
