#include "tungsten/io/ContactSheet.h"

#include "tungsten/io/Format.h"
#include "tungsten/io/Writers.h"

#include <algorithm>
#include <cmath>

namespace tungsten {

namespace {

constexpr int MostFrames = 64, MostWidth = 2000, Gap = 2;
constexpr float GapGrey = 0.02f;

/// Means of blocks of `side` x `side` pixels; what is left over at the right and below is cut.
Image shrunk(const Image& image, int side) {
    Image small(std::max(image.width / side, 1), std::max(image.height / side, 1));
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            Vec3d sum(0.0);
            int pixels = 0;
            for (int v = y * side; v < std::min((y + 1) * side, image.height); ++v)
                for (int u = x * side; u < std::min((x + 1) * side, image.width); ++u, ++pixels) {
                    const Rgb& pixel = image.at(u, v);
                    sum += Vec3d(double(pixel.x), double(pixel.y), double(pixel.z));
                }
            const Vec3d mean = sum / double(pixels);
            small.at(x, y) = Rgb(float(mean.x), float(mean.y), float(mean.z));
        }
    return small;
}

} // namespace

std::vector<int> sheetFrames(int frames) {
    const int shown = std::min(frames, MostFrames);
    std::vector<int> chosen;
    for (int i = 0; i < shown; ++i)
        chosen.push_back(shown > 1 ? int(int64_t(i) * int64_t(frames - 1) / int64_t(shown - 1)) : 0);
    return chosen;
}

Image contactSheet(const std::vector<int>& frames, const std::function<Image(int)>& frameOf) {
    if (frames.empty()) return {};
    const int columns = int(std::ceil(std::sqrt(double(frames.size()))));
    const int rows = (int(frames.size()) + columns - 1) / columns;
    Image sheet;
    for (size_t i = 0; i < frames.size(); ++i) {
        const Image frame = frameOf(frames[i]);
        const int side = std::max((columns * frame.width + MostWidth - 1) / MostWidth, 1);
        const Image small = shrunk(frame, side);
        if (i == 0) {
            sheet = Image(columns * (small.width + Gap) - Gap, rows * (small.height + Gap) - Gap);
            std::fill(sheet.pixels.begin(), sheet.pixels.end(), Rgb(GapGrey));
        }
        const int left = (int(i) % columns) * (small.width + Gap), top = (int(i) / columns) * (small.height + Gap);
        for (int y = 0; y < small.height; ++y)
            for (int x = 0; x < small.width; ++x) sheet.at(left + x, top + y) = small.at(x, y);
    }
    return sheet;
}

extern const OutputFormat SheetFormat{.extension = ".png",
                                      .uses = output_use::Sheet,
                                      .holdsFrames = true,
                                      .write = [](const OutputFilm& film, const OutputImage& image) {
                                          const auto shown = [&](int frame) { return film.shownFrame(frame); };
                                          writePng(image.file, contactSheet(sheetFrames(film.frames()), shown),
                                                   film.scene().toneMap);
                                      }};

} // namespace tungsten
