#pragma once

namespace tungsten {

/// What a film keeps of every pixel of every frame.
struct FilmContents {
    int channels = 3;    ///< 3: linear RGB, 1: luminance
    bool moments = true; ///< second moments, for the standard error of every pixel of every frame

    bool operator==(const FilmContents&) const = default;
    /// Floats per pixel and frame: the mean, its moment, and the pass in progress.
    [[nodiscard]] int floats() const { return channels * (moments ? 3 : 2); }
};

} // namespace tungsten
