#pragma once

namespace tungsten {

/// What a film keeps of every pixel of every frame.
struct FilmContents {
    int channels = 3;    ///< 3: linear RGB, 1: luminance
    bool moments = true; ///< second moments, for the standard error of every pixel of every frame
    int batches = 0;     ///< groups of passes whose means are kept, for the errors of regions; 0: none
    int batchBlock = 4;  ///< those are means over blocks of so many pixels' side

    bool operator==(const FilmContents&) const = default;
    /// Numbers per channel, pixel and frame: the pass in progress, the mean, its moment.
    [[nodiscard]] int parts() const { return moments ? 3 : 2; }
    /// Image rows that go together where a film is taken apart by rows.
    [[nodiscard]] int rowsTogether() const { return batches > 0 ? batchBlock : 1; }
};

} // namespace tungsten
