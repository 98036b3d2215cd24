#pragma once
// Means over groups of passes: what tells the error of a region, whose pixels correlate.

#include "tungsten/film/FilmContents.h"
#include "tungsten/film/Tiles.h"

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <vector>

namespace tungsten {

/// Pass i belongs to batch i mod N. Each batch keeps the mean of its passes (weighed as the film weighs them) by
/// blocks of pixels, in every frame. Batches are independent, whatever correlates within a pass: the standard error of
/// any sum of blocks is the spread of that sum over the batches.
class BatchMeans {
  public:
    BatchMeans() = default;
    BatchMeans(int width, int height, int frames, const FilmContents& contents);
    [[nodiscard]] static double memoryFor(int width, int height, int frames, const FilmContents& contents);

    [[nodiscard]] int count() const { return int(weights_.size()); }
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    /// Of passes, by batch.
    [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
    /// (batch, frame, row of blocks, column of blocks, channel).
    [[nodiscard]] const LazyArray& means() const { return means_; }

    /// Reads the pass's values of a row of frames.
    using ReadRow = std::function<void(size_t row, float* values)>;
    /// Adds image rows from..end of a pass, whole blocks' (or up to the last row); `lit` tells by row of frames where
    /// any pass has had light. Once per pass: nextPass() goes after it.
    void accumulate(uint32_t pass, double weight, const ReadRow& readRow, const std::vector<uint8_t>& lit, int from,
                    int end);
    void nextPass(uint32_t pass, double weight);

    /// Exact binary state of image rows from..end. read() leaves a stream that failed to its caller.
    void write(std::ostream& out, int from, int end) const;
    void read(std::istream& in, int from, int end);

  private:
    void accumulateRow(uint32_t batch, int frame, int blockRow, double weight, const ReadRow& readRow);
    [[nodiscard]] size_t rowAt(size_t batch, int frame, int blockRow) const {
        return ((batch * size_t(frames_) + size_t(frame)) * size_t(rows_) + size_t(blockRow)) * size_t(columns_) *
               size_t(channels_);
    }
    /// Calls use(first value, values) with every row of blocks of these image rows.
    template <typename Use>
    void forRows(int from, int end, const Use& use) const;

    int width_ = 0, height_ = 0, frames_ = 0, channels_ = 3, side_ = 1, columns_ = 0, rows_ = 0;
    std::vector<double> weights_;
    LazyArray means_;
};

} // namespace tungsten
