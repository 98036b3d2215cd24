#pragma once
// The accumulator: frames x pixels, with the mean and second moment of pass images, so every render knows its standard
// error. FilmErrors.h has figures of errors, FilmRows.h what takes a film apart by rows and keeps it in files.

#include "tungsten/core/Types.h"
#include "tungsten/film/BatchMeans.h"
#include "tungsten/film/ErrorConfidence.h"
#include "tungsten/film/FilmContents.h"
#include "tungsten/film/StochasticRounding.h"
#include "tungsten/film/Tiles.h"
#include "tungsten/image/Image.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

namespace tungsten {

/// What the weight of a pass says.
enum class PassWeight {
    Samples, ///< the pass is the mean of so many samples: its variance is inversely proportional to them
    Repeats, ///< the pass stands for so many like it; all have one variance
};

/// A pass that mean and second moment have, on its way to the estimate of the error.
struct AccumulatedPass {
    uint32_t pass = 0;                                            ///< its index
    double weight = 1.0, weightBefore = 0.0, squaresBefore = 0.0; ///< of the pass; sums over those before it
    std::vector<PassSpread> rows{}; ///< by image row; squares: what it adds to second moments
};

/// Progressive estimate of every pixel of every frame. A pass adds one image per frame; passes may weigh differently
/// (by samples per pixel). Mean and second moment follow West (1979), so adding in the same order gives the same bits.
/// Rows of frames that no pass adds to take no time, and runs of 16 pixels in them no memory.
class Film {
  public:
    Film() = default;
    Film(int width, int height, int frames, FilmContents contents = {}, PassWeight meaning = PassWeight::Samples);
    /// Bytes that such a film takes once every row has light.
    [[nodiscard]] static double memoryFor(int width, int height, int frames, FilmContents contents = {});

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int frames() const { return frames_; }
    [[nodiscard]] const FilmContents& contents() const { return contents_; }
    [[nodiscard]] uint32_t passes() const { return passes_; }
    [[nodiscard]] double totalWeight() const { return weight_; }

    /// The image of the pass in progress is zeroed; integrators add up each pixel's mean over the pass's samples.
    void beginPass();
    /// To the image of the pass in progress. Threads may add to different pixels at once.
    void add(int frame, int x, int y, const Rgb& value);
    /// Instead of what the pass in progress has there.
    void set(int frame, int x, int y, const Rgb& value) {
        float* tile = tiles_.find(tileOf(row(frame, y), x));
        if (tile) std::fill_n(tile + inTile(x), contents_.channels, 0.0f);
        add(frame, x, y, value);
    }
    /// Of the pass in progress, or the last one.
    [[nodiscard]] Rgb passPixel(int frame, int x, int y) const {
        const float* tile = tiles_.find(tileOf(row(frame, y), x));
        return tile ? rgb(tile + inTile(x)) : Rgb(0.0f);
    }
    /// Adds the pass image to mean and second moment with the given weight (> 0). Non-finite pixels are counted, and
    /// replaced by 0.
    void endPass(double weight) { finishPass(accumulateRows(weight, 0, height_)); }
    [[nodiscard]] const BatchMeans& batches() const { return batches_; }
    [[nodiscard]] uint64_t nonFiniteSamples() const { return nonFinite_; }
    void countNonFinite(uint64_t n) { nonFinite_ += n; }

    [[nodiscard]] Image mean(int frame) const;
    /// Standard error of mean(frame) per pixel; NaN while it is unknown: with fewer than two passes, without moments.
    [[nodiscard]] Image standardError(int frame) const;
    /// Mean over the frames: the image of the whole gate.
    [[nodiscard]] Image meanOverFrames() const;
    [[nodiscard]] Image standardErrorOverFrames() const;
    /// The mean of a function of the values of the mean, over pixels, channels and frames; 0 of a film without values.
    template <typename Function>
    [[nodiscard]] double meanOf(const Function& function) const;
    /// Mean over pixels, channels and frames of the squared standard error. NaN while it is unknown.
    [[nodiscard]] double meanSquaredError() const;
    /// How sure meanSquaredError() is (FilmErrors.h).
    [[nodiscard]] const ErrorConfidence& confidence() const { return confidence_; }
    [[nodiscard]] size_t memoryBytes() const;

  private:
    friend struct FilmRows; // takes a film apart and puts it together again

    static constexpr int TileShift = 4;
    static constexpr size_t TilePixels = size_t(1) << TileShift;
    /// What a tile holds, one after the other.
    enum Part { Pass, Mean, Moment };

    [[nodiscard]] size_t row(int frame, int y) const { return size_t(frame) * size_t(height_) + size_t(y); }
    /// Of a row's tiles, the one that has pixel x, and where in it.
    [[nodiscard]] size_t tileOf(size_t row, int x) const { return row * tilesInRow_ + (size_t(x) >> TileShift); }
    [[nodiscard]] size_t inTile(int x) const { return (size_t(x) & (TilePixels - 1)) * size_t(contents_.channels); }
    /// Of one part; narrow films have narrow tiles.
    [[nodiscard]] size_t tileValues() const {
        return std::min(TilePixels, size_t(width_)) * size_t(contents_.channels);
    }
    [[nodiscard]] size_t rowValues() const { return size_t(width_) * size_t(contents_.channels); }
    /// Values of a row: those of a part of its tiles, zeros where there are none.
    void readRow(size_t row, Part part, float* values) const;
    /// Makes tiles where values are not zero.
    void writeRow(size_t row, Part part, const float* values);
    /// Calls use(number, first value in the row, how many) for every tile of a row.
    template <typename Use>
    void forTiles(const Use& use) const;
    [[nodiscard]] float* passPixelToChange(int frame, int x, int y) {
        const std::atomic_ref<uint8_t> touched(touched_[row(frame, y)]);
        if (!touched.load(std::memory_order_relaxed)) touched.store(1, std::memory_order_relaxed);
        return tiles_.make(tileOf(row(frame, y), x)) + inTile(x);
    }
    [[nodiscard]] Rgb rgb(const float* values) const {
        return contents_.channels == 1 ? Rgb(*values) : Rgb(values[0], values[1], values[2]);
    }
    /// endPass() in two steps: the first accumulates rows [from, end) and returns their spread, the second adds the
    /// spread of all rows to the error estimate.
    [[nodiscard]] AccumulatedPass accumulateRows(double weight, int from, int end);
    void finishPass(const AccumulatedPass& pass);
    /// What accumulating an image row adds up over its frames.
    struct RowSums {
        std::vector<double> values, blocks; ///< of the pass; of its deviations, by block
        double squares = 0.0;               ///< what the row adds to second moments
        uint64_t nonFinite = 0;
    };
    /// One row of a frame of the pass into the means.
    void accumulateRow(size_t row, double weight, RowSums& sums);
    /// The same of a tile, whose first value has this place in the film and the row.
    void accumulateTile(float* tile, size_t place, size_t first, size_t count, double weight, RowSums& sums);
    /// Of an image row whose blocks deviate by `blocks` times `scale`, which go into its group of passes.
    PassSpread deviationOf(size_t y, double squares, const std::vector<double>& blocks, double scale);
    [[nodiscard]] Image imageOf(const float* values) const;
    [[nodiscard]] Image imageOf(int frame, Part part) const;
    /// The root of the second moments times errorScale().
    [[nodiscard]] Image errorImage(Image moments) const;
    /// From a second moment to the squared standard error; NaN while it is unknown.
    [[nodiscard]] double errorScale() const;
    /// From what a pass adds to second moments to an estimate of its variance; from its squared deviation to that.
    [[nodiscard]] double momentScale(const AccumulatedPass& pass) const;
    [[nodiscard]] double deviationScale(const AccumulatedPass& pass) const;

    int width_ = 0, height_ = 0, frames_ = 0;
    FilmContents contents_;
    PassWeight meaning_ = PassWeight::Samples;
    uint32_t passes_ = 0;
    double weight_ = 0.0, squaredWeights_ = 0.0; ///< sums over the passes
    double moment2Sum_ = 0.0;                    ///< of all pixels and channels
    uint64_t nonFinite_ = 0;
    ErrorConfidence confidence_;
    /// Deviations of the last group of passes and of the one under way, summed over frames and the pixels of a block,
    /// by image row.
    std::vector<float> lastBlocks_, blocks_;
    BatchMeans batches_;
    size_t tilesInRow_ = 0;
    LazyTiles tiles_;
    std::vector<uint8_t> touched_, lit_;          ///< rows of frames to which this pass, any pass added
    std::vector<float> totalMean_, totalMoment2_; ///< of the mean over frames (frames > 1)
};

template <typename Use>
void Film::forTiles(const Use& use) const {
    for (size_t tile = 0; tile < tilesInRow_; ++tile) {
        const size_t first = (tile << TileShift) * size_t(contents_.channels);
        use(tile, first, std::min(tileValues(), rowValues() - first));
    }
}

template <typename Function>
double Film::meanOf(const Function& function) const {
    double sum = 0.0;
    for (size_t row = 0; row < lit_.size(); ++row)
        forTiles([&](size_t tile, size_t, size_t count) {
            const float* found = lit_[row] != 0 ? tiles_.find(row * tilesInRow_ + tile) : nullptr;
            for (size_t i = 0; found && i < count; ++i) sum += function(double(found[size_t(Mean) * tileValues() + i]));
        });
    const double values = double(lit_.size()) * double(rowValues());
    return values > 0.0 ? sum / values : 0.0;
}

} // namespace tungsten
