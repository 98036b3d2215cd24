#pragma once
// The accumulator: frames x pixels, with the mean and second moment of pass images, so every render knows its standard
// error.

#include "tungsten/core/Types.h"
#include "tungsten/film/FilmContents.h"
#include "tungsten/film/LazyTiles.h"
#include "tungsten/film/MeanUpdate.h"
#include "tungsten/film/PassBatches.h"
#include "tungsten/film/PassScatter.h"
#include "tungsten/image/Image.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace tungsten {

/// What the weight of a pass says.
enum class PassWeight {
    Samples, ///< the pass is the mean of so many samples: its variance is inversely proportional to them
    Repeats, ///< the pass stands for so many like it; all have one variance
};

/// A pass that has been folded in, on its way to the film's figures.
struct FoldedPass {
    uint32_t pass = 0;                                            ///< its index
    double weight = 1.0, weightBefore = 0.0, squaresBefore = 0.0; ///< of the pass; sums over those before it
    std::vector<PassDeviation> rows{}; ///< by image row; squares: what it adds to second moments
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
    /// Rows of frames, frame by frame: whether the pass in progress has light there, and its values by pixel.
    [[nodiscard]] size_t passRows() const { return touched_.size(); }
    [[nodiscard]] bool passRowIsLit(size_t row) const { return touched_[row] != 0; }
    [[nodiscard]] size_t rowValues() const { return size_t(width_) * size_t(contents_.channels); }
    void readPassRow(size_t row, float* values) const { readRow(row, Pass, values); }
    /// Instead of what the pass in progress has there; such a row counts as lit.
    void setPassRow(size_t row, const float* values);
    /// Folds the pass image in with the given weight (> 0). Non-finite pixels are counted, and replaced by 0.
    void endPass(double weight) { settle(foldRows(weight, 0, height_)); }
    /// The same in two steps, for a film that is kept apart by image rows: rows from..end are folded; what all rows
    /// deviate, pass by pass, goes into the film's figures (in which FoldedPass::rows are all rows).
    [[nodiscard]] FoldedPass foldRows(double weight, int from, int end);
    void settle(const FoldedPass& pass);
    [[nodiscard]] const PassBatches& batches() const { return batches_; }
    [[nodiscard]] uint64_t nonFiniteSamples() const { return nonFinite_; }
    void countNonFinite(uint64_t n) { nonFinite_ += n; }

    [[nodiscard]] Image mean(int frame) const;
    /// Standard error of mean(frame) per pixel; NaN while it is unknown: with fewer than two passes, without moments.
    [[nodiscard]] Image standardError(int frame) const;
    /// Mean over the frames: the image of the whole gate.
    [[nodiscard]] Image meanOverFrames() const;
    [[nodiscard]] Image standardErrorOverFrames() const;
    /// Over pixels, channels and frames: of the mean, of its square, of the squared standard error (NaN: unknown).
    [[nodiscard]] double meanValue() const;
    [[nodiscard]] double meanSquare() const;
    [[nodiscard]] double meanSquaredError() const;
    /// Factor >= 1 from the root of meanSquaredError() to what the error that was made does not exceed with a
    /// confidence of 95 % (PassScatter). NaN with fewer than five passes.
    [[nodiscard]] double boundFactor() const { return scatter_.boundFactor(); }
    /// rms over pixels and frames of the standard error, relative to the mean pixel value. NaN while it is unknown:
    /// with fewer than two passes, or black.
    [[nodiscard]] double relativeStandardError() const;
    /// What the error that was made, as relativeStandardError() counts it, does not exceed with a confidence of 95 %
    /// (PassScatter). NaN while it is unknown: with fewer than five passes, or black.
    [[nodiscard]] double relativeErrorBound() const { return relativeStandardError() * boundFactor(); }
    [[nodiscard]] size_t memoryBytes() const;

    /// Exact binary state for checkpoints. read() throws InputError(file name, ...) on a mismatch or truncation.
    void write(std::ostream& out) const;
    void read(std::istream& in, const std::string& fileName);
    /// The same of image rows from..end, with the number and weight of passes, but without the film's figures.
    void writeRows(std::ostream& out, int from, int end) const;
    void readRows(std::istream& in, int from, int end);

  private:
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
    /// What the folding of an image row adds up over its frames.
    struct RowSums {
        std::vector<double> values, blocks; ///< of the pass; of its deviations, by block
        double squares = 0.0;               ///< what the row adds to second moments
        uint64_t nonFinite = 0;
    };
    /// One row of a frame of the pass into the means.
    void foldRow(size_t row, double weight, RowSums& sums);
    /// The same of a tile, whose first value has this place in the film and the row.
    void foldTile(float* tile, size_t place, size_t first, size_t count, double weight, RowSums& sums);
    /// Of an image row whose blocks deviate by `blocks` times `scale`, which go into its group of passes.
    PassDeviation deviationOf(size_t y, double squares, const std::vector<double>& blocks, double scale);
    /// Of a function of the values of all pixels of all frames.
    template <typename Function>
    [[nodiscard]] double meanOf(const Function& function) const;
    [[nodiscard]] Image imageOf(const float* values) const;
    [[nodiscard]] Image imageOf(int frame, Part part) const;
    /// The root of the second moments times errorScale().
    [[nodiscard]] Image errorImage(Image moments) const;
    /// From a second moment to the squared standard error; NaN while it is unknown.
    [[nodiscard]] double errorScale() const;
    /// From what a pass adds to second moments to an estimate of its variance; from its squared deviation to that.
    [[nodiscard]] double momentScale(const FoldedPass& pass) const;
    [[nodiscard]] double deviationScale(const FoldedPass& pass) const;

    int width_ = 0, height_ = 0, frames_ = 0;
    FilmContents contents_;
    PassWeight meaning_ = PassWeight::Samples;
    uint32_t passes_ = 0;
    double weight_ = 0.0, squaredWeights_ = 0.0; ///< sums over the passes
    double moment2Sum_ = 0.0;                    ///< of all pixels and channels
    uint64_t nonFinite_ = 0;
    PassScatter scatter_;
    /// Deviations of the last group of passes and of the one under way, summed over frames and the pixels of a block,
    /// by image row.
    std::vector<float> lastBlocks_, blocks_;
    PassBatches batches_;
    size_t tilesInRow_ = 0;
    LazyTiles tiles_;
    std::vector<uint8_t> touched_, lit_;          ///< rows of frames to which this pass, any pass added
    std::vector<float> totalMean_, totalMoment2_; ///< of the mean over frames (frames > 1)
};

} // namespace tungsten
