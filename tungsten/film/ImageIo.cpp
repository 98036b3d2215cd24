// Formats of our own few lines: PFM, text; PNG through stb.

#include "tungsten/film/ImageIo.h"

#include "tungsten/core/Errors.h"
#include "tungsten/film/AtomicFile.h"

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

#include <fstream>

namespace tungsten {

namespace {

constexpr int LargestSide = 1 << 20;

void writeRow(std::ostream& out, const Image& image, int y) {
    out.write(reinterpret_cast<const char*>(&image.at(0, y)), std::streamsize(size_t(image.width) * sizeof(Rgb)));
}

} // namespace

std::vector<uint8_t> toneMapped(const Image& image, ToneMap toneMap) {
    std::vector<uint8_t> bytes;
    bytes.reserve(image.pixels.size() * 3);
    for (const Rgb& pixel : image.pixels)
        for (const uint8_t byte : toLdr(applyToneMap(toneMap, pixel))) bytes.push_back(byte);
    return bytes;
}

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

void writePfm(const std::filesystem::path& file, const Image& image) {
    writeAtomically(file, [&](std::ostream& out) {
        out << "PF\n" << image.width << " " << image.height << "\n-1\n";
        for (int y = image.height - 1; y >= 0; --y) writeRow(out, image, y);
    });
}

Image readPfm(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError(file.string(), "no such file, or it cannot be read");
    std::string magic;
    int width = 0, height = 0;
    double scale = 0.0;
    in >> magic >> width >> height >> scale;
    in.get();
    if (!in || (magic != "PF" && magic != "Pf") || width <= 0 || height <= 0 || width > LargestSide ||
        height > LargestSide)
        throw InputError(file.string(), "not a PFM image");
    const size_t channels = magic == "PF" ? 3 : 1;
    std::error_code error;
    if (std::filesystem::file_size(file, error) < size_t(width) * size_t(height) * channels * 4 || error)
        throw InputError(file.string(), "the PFM image is truncated");
    Image image(width, height);
    std::vector<float> row(size_t(width) * channels);
    for (int y = height - 1; y >= 0; --y) {
        in.read(reinterpret_cast<char*>(row.data()), std::streamsize(row.size() * sizeof(float)));
        if (!in) throw InputError(file.string(), "the PFM image is truncated");
        for (int x = 0; x < width; ++x) {
            const float* texel = &row[size_t(x) * channels];
            image.at(x, y) = channels == 3 ? Rgb(texel[0], texel[1], texel[2]) : Rgb(texel[0]);
        }
    }
    return image;
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    writeAtomically(file, [&](std::ostream& out) { out << text; });
}

std::filesystem::path framePath(const std::filesystem::path& file, int frame, int frames) {
    const size_t digits = std::max<size_t>(std::to_string(std::max(frames - 1, 0)).size(), 2);
    const std::string number = std::to_string(frame);
    const std::string padded = std::string(digits - std::min(digits, number.size()), '0') + number;
    return file.parent_path() / (file.stem().string() + "_" + padded + file.extension().string());
}

} // namespace tungsten
