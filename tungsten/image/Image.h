#pragma once
// Images of linear RGB.

#include "tungsten/core/Types.h"

#include <cstddef>
#include <vector>

namespace tungsten {

/// Row-major RGB image, row 0 at the top.
struct Image {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(size_t(w) * size_t(h), Rgb(0.0f)) {}
    [[nodiscard]] Rgb& at(int x, int y) { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
    [[nodiscard]] const Rgb& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
};

/// Rec. 709, of linear RGB.
inline float luminanceOf(const Rgb& value) {
    return 0.2126f * value.x + 0.7152f * value.y + 0.0722f * value.z;
}

} // namespace tungsten
