// PFM: `PF`, little-endian floats, rows bottom to top.

#include "tungsten/image/AtomicFile.h"
#include "tungsten/io/Format.h"
#include "tungsten/io/Writers.h"

namespace tungsten {

namespace {

void writeRow(std::ostream& out, const Image& image, int y) {
    out.write(reinterpret_cast<const char*>(&image.at(0, y)), std::streamsize(size_t(image.width) * sizeof(Rgb)));
}

} // namespace

void writePfm(const std::filesystem::path& file, const Image& image) {
    writeAtomically(file, [&](std::ostream& out) {
        out << "PF\n" << image.width << " " << image.height << "\n-1\n";
        for (int y = image.height - 1; y >= 0; --y) writeRow(out, image, y);
    });
}

extern const OutputFormat PfmFormat{.extension = ".pfm",
                                    .uses = output_use::Linear | output_use::Series,
                                    .write = [](const OutputFilm& film, const OutputImage& image) {
                                        writePfm(image.file, image.frame ? film.frame(*image.frame) : film.whole());
                                    }};

} // namespace tungsten
