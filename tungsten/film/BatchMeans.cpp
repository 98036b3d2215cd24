#include "tungsten/film/BatchMeans.h"

#include "tungsten/film/StochasticRounding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <istream>
#include <ostream>

namespace tungsten {

namespace {

int blocksOf(int pixels, int side) {
    return (pixels + side - 1) / side;
}

} // namespace

BatchMeans::BatchMeans(int width, int height, int frames, const FilmContents& contents)
    : width_(width), height_(height), frames_(frames), channels_(contents.channels), side_(contents.batchBlock),
      columns_(blocksOf(width, side_)), rows_(blocksOf(height, side_)), weights_(size_t(contents.batches), 0.0),
      means_(rowAt(size_t(contents.batches), 0, 0)) {}

double BatchMeans::memoryFor(int width, int height, int frames, const FilmContents& contents) {
    return double(blocksOf(width, contents.batchBlock)) * double(blocksOf(height, contents.batchBlock)) *
           double(frames) * double(contents.channels) * double(contents.batches) * double(sizeof(float));
}

void BatchMeans::accumulateRow(uint32_t batch, int frame, int blockRow, double weight, const ReadRow& readRow) {
    const auto channels = size_t(channels_);
    const int top = blockRow * side_, bottom = std::min(top + side_, height_);
    std::vector<double> sums(size_t(columns_) * channels, 0.0);
    std::vector<float> row(size_t(width_) * channels);
    for (int y = top; y < bottom; ++y) {
        readRow(size_t(frame) * size_t(height_) + size_t(y), row.data());
        for (int x = 0; x < width_; ++x)
            for (size_t c = 0; c < channels; ++c)
                sums[size_t(x / side_) * channels + c] += double(row[size_t(x) * channels + c]);
    }
    const size_t first = rowAt(batch, frame, blockRow);
    for (size_t i = 0; i < sums.size(); ++i) {
        const int left = int(i / channels) * side_, pixels = (std::min(left + side_, width_) - left) * (bottom - top);
        welford(float(sums[i] / double(pixels)), weight, weights_[batch], roundingBits(batch, first + i),
                means_[first + i]);
    }
}

void BatchMeans::accumulate(uint32_t pass, double weight, const ReadRow& readRow, const std::vector<uint8_t>& lit,
                            int from, int end) {
    if (weights_.empty()) return;
    const auto batch = uint32_t(pass % weights_.size());
    tbb::parallel_for(from / side_, blocksOf(end, side_), [&](int blockRow) {
        const int top = blockRow * side_, bottom = std::min(top + side_, height_);
        for (int frame = 0; frame < frames_; ++frame) {
            const auto rows = lit.begin() + ptrdiff_t(frame) * height_;
            if (std::any_of(rows + top, rows + bottom, [](uint8_t row) { return row != 0; }))
                accumulateRow(batch, frame, blockRow, weight, readRow);
        }
    });
}

void BatchMeans::nextPass(uint32_t pass, double weight) {
    if (!weights_.empty()) weights_[pass % weights_.size()] += weight;
}

template <typename Use>
void BatchMeans::forRows(int from, int end, const Use& use) const {
    const size_t values = size_t(columns_) * size_t(channels_);
    for (size_t batch = 0; batch < weights_.size(); ++batch)
        for (int frame = 0; frame < frames_; ++frame)
            for (int row = from / side_; row < blocksOf(end, side_); ++row) use(rowAt(batch, frame, row), values);
}

void BatchMeans::write(std::ostream& out, int from, int end) const {
    out.write(reinterpret_cast<const char*>(weights_.data()), std::streamsize(weights_.size() * sizeof(double)));
    forRows(from, end, [&](size_t first, size_t values) {
        out.write(reinterpret_cast<const char*>(means_.data() + first), std::streamsize(values * sizeof(float)));
    });
}

void BatchMeans::read(std::istream& in, int from, int end) {
    in.read(reinterpret_cast<char*>(weights_.data()), std::streamsize(weights_.size() * sizeof(double)));
    forRows(from, end, [&](size_t first, size_t values) {
        in.read(reinterpret_cast<char*>(means_.data() + first), std::streamsize(values * sizeof(float)));
    });
}

} // namespace tungsten
