#include "tungsten/film/Film.h"

#include "tungsten/core/Errors.h"
#include "tungsten/film/StochasticRounding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tungsten {

namespace {

constexpr double LargestFilmBytes = 16.0 * 1024 * 1024 * 1024;
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

/// Of a row, whose deviations are summed to one number: every pixel of small films, some 4096 blocks of larger ones, of
/// no more than `most` pixels (a power of two, as this is).
size_t blockPixelsOf(int width, int height, size_t most) {
    constexpr size_t Blocks = 4096;
    return std::min(std::bit_ceil(std::max(size_t(width) * size_t(height) / Blocks, size_t(1))), most);
}

} // namespace

Film::Film(int width, int height, int frames, FilmContents contents, PassWeight meaning)
    : width_(width), height_(height), frames_(frames), contents_(contents), meaning_(meaning) {
    const double bytes = memoryFor(width, height, frames, contents);
    if (bytes > LargestFilmBytes)
        throw InputError("film", std::to_string(width) + "x" + std::to_string(height) + " pixels in " +
                                     std::to_string(frames) + " frames would take " +
                                     std::to_string(int(bytes / (1024.0 * 1024 * 1024))) +
                                     " GiB; the limit is 16 GiB: use fewer frames, film.channels luminance, no " +
                                     "film.moments or a smaller --resolution");
    const size_t values = size_t(width) * size_t(height) * size_t(contents.channels);
    tilesInRow_ = (size_t(width) + TilePixels - 1) >> TileShift;
    tiles_ = LazyTiles(tilesInRow_ * size_t(height) * size_t(frames), tileValues() * size_t(contents.parts()));
    if (contents.batches > 0) batches_ = BatchMeans(width, height, frames, contents);
    const size_t ofBlock = blockPixelsOf(width, height, TilePixels);
    blocks_.assign((size_t(width) + ofBlock - 1) / ofBlock * size_t(height), 0.0f);
    lastBlocks_ = blocks_;
    touched_.assign(size_t(height) * size_t(frames), 0);
    lit_ = touched_;
    if (frames > 1) {
        totalMean_.assign(values, 0.0f);
        totalMoment2_ = totalMean_;
    }
}

double Film::memoryFor(int width, int height, int frames, FilmContents contents) {
    const int tiles = (width + int(TilePixels) - 1) >> TileShift;
    const double floats = double(std::min(int(TilePixels), width)) * contents.channels * contents.parts();
    return double(height) * double(frames) * tiles * (floats * sizeof(float) + sizeof(uint32_t)) +
           2.0 * double(height) * double(width) *
               (1.0 / double(blockPixelsOf(width, height, TilePixels)) + double(contents.channels)) * sizeof(float) +
           BatchMeans::memoryFor(width, height, frames, contents);
}

void Film::readRow(size_t row, Part part, float* values) const {
    forTiles([&](size_t tile, size_t first, size_t count) {
        if (const float* found = tiles_.find(row * tilesInRow_ + tile))
            std::copy_n(found + size_t(part) * tileValues(), count, values + first);
        else
            std::fill_n(values + first, count, 0.0f);
    });
}

void Film::writeRow(size_t row, Part part, const float* values) {
    forTiles([&](size_t tile, size_t first, size_t count) {
        const size_t place = row * tilesInRow_ + tile;
        const auto isZero = [](float value) { return value == 0.0f; };
        if (!tiles_.find(place) && std::all_of(values + first, values + first + count, isZero)) return;
        std::copy_n(values + first, count, tiles_.make(place) + size_t(part) * tileValues());
    });
}

void Film::beginPass() {
    tbb::parallel_for(size_t(0), touched_.size(), [&](size_t row) {
        if (touched_[row] == 0) return;
        forTiles([&](size_t tile, size_t, size_t count) {
            if (float* found = tiles_.find(row * tilesInRow_ + tile)) std::fill_n(found, count, 0.0f);
        });
        touched_[row] = 0;
    });
}

// Not inline: where callers round sums of doubles to these floats, GCC 12 vectorises both and leaves the rounding out.
void Film::add(int frame, int x, int y, const Rgb& value) {
    if (value == Rgb(0.0f)) return;
    float* pixel = passPixelToChange(frame, x, y);
    if (contents_.channels == 1)
        addStochastic(*pixel, luminanceOf(value));
    else
        for (int c = 0; c < 3; ++c) addStochastic(pixel[c], value[c]);
}

void Film::accumulateTile(float* tile, size_t place, size_t first, size_t count, double weight, RowSums& sums) {
    float *means = tile + size_t(Mean) * tileValues(), *moments = tile + size_t(Moment) * tileValues();
    const size_t ofBlock = blockPixelsOf(width_, height_, TilePixels) * size_t(contents_.channels);
    for (size_t i = 0, block = first / ofBlock; i < count; ++block) {
        double deviation = 0.0;
        for (const size_t end = std::min(i + ofBlock, count); i < end; ++i) {
            const uint64_t bits = roundingBits(passes_, place + first + i);
            deviation += double(tile[i]) - double(means[i]);
            sums.squares += contents_.moments ? welford(tile[i], weight, weight_, bits, means[i], moments[i])
                                              : welford(tile[i], weight, weight_, bits, means[i]);
            sums.values[first + i] += double(tile[i]);
        }
        sums.blocks[block] += deviation;
    }
}

void Film::accumulateRow(size_t row, double weight, RowSums& sums) {
    if (touched_[row] != 0) lit_[row] = 1;
    if (lit_[row] == 0) return;
    forTiles([&](size_t tile, size_t first, size_t count) {
        float* found = tiles_.find(row * tilesInRow_ + tile);
        if (!found) return;
        for (size_t x = 0; x < count; x += size_t(contents_.channels))
            if (!isFinite(rgb(found + x))) {
                ++sums.nonFinite;
                std::fill_n(found + x, contents_.channels, 0.0f);
            }
        accumulateTile(found, row * rowValues(), first, count, weight, sums);
    });
}

PassSpread Film::deviationOf(size_t y, double squares, const std::vector<double>& blocks, double scale) {
    PassSpread deviation{squares, 0.0, 0.0};
    const bool endsGroup = ErrorConfidence::groupEndingWith(passes_) > 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
        float &last = lastBlocks_[y * blocks.size() + i], &group = blocks_[y * blocks.size() + i];
        group += float(blocks[i] * scale);
        if (!endsGroup) continue;
        deviation.blocks += double(group) * double(group);
        deviation.product += double(group) * double(last);
        last = group;
        group = 0.0f;
    }
    return deviation;
}

AccumulatedPass Film::accumulateRows(double weight, int from, int end) {
    const size_t values = rowValues();
    AccumulatedPass accumulated{passes_, weight, weight_, squaredWeights_, std::vector<PassSpread>(size_t(end - from))};
    const double scale = std::sqrt(deviationScale(accumulated));
    std::vector<uint64_t> rowNonFinite(accumulated.rows.size(), 0);
    tbb::parallel_for(size_t(from), size_t(end), [&](size_t y) {
        RowSums sums{std::vector<double>(values, 0.0), std::vector<double>(blocks_.size() / size_t(height_), 0.0)};
        for (int frame = 0; frame < frames_; ++frame) accumulateRow(row(frame, int(y)), weight, sums);
        accumulated.rows[y - size_t(from)] = deviationOf(y, sums.squares, sums.blocks, scale);
        rowNonFinite[y - size_t(from)] = sums.nonFinite;
        if (frames_ == 1) return;
        for (size_t i = 0; i < values; ++i)
            welford(float(sums.values[i] / frames_), weight, weight_, roundingBits(passes_, ~uint64_t(y * values + i)),
                    totalMean_[y * values + i], totalMoment2_[y * values + i]);
    });
    for (const uint64_t count : rowNonFinite) nonFinite_ += count;
    const auto readPass = [&](size_t row, float* row_values) { readRow(row, Pass, row_values); };
    batches_.accumulate(passes_, weight, readPass, lit_, from, end);
    batches_.nextPass(passes_, weight);
    weight_ += weight;
    squaredWeights_ += weight * weight;
    ++passes_;
    return accumulated;
}

void Film::finishPass(const AccumulatedPass& pass) {
    PassSpread sum;
    for (const PassSpread& row : pass.rows) {
        sum.squares += row.squares;
        sum.blocks += row.blocks;
        sum.product += row.product;
    }
    moment2Sum_ += sum.squares;
    if (!(pass.weightBefore > 0.0)) return;
    sum.squares *= momentScale(pass);
    confidence_.add(pass.pass, sum);
}

double Film::momentScale(const AccumulatedPass& pass) const {
    // Second moments get the squared distance of the pass from the mean before it, times this.
    const double ofDistance = pass.weight * pass.weightBefore / (pass.weight + pass.weightBefore);
    return deviationScale(pass) / ofDistance;
}

double Film::deviationScale(const AccumulatedPass& pass) const {
    // The squared distance from the mean before over what is expected of it with a variance of 1, or of 1 / weight.
    const double before = pass.weightBefore;
    if (!(before > 0.0)) return 0.0;
    if (meaning_ == PassWeight::Samples) return pass.weight * before / (pass.weight + before);
    return 1.0 / (1.0 + pass.squaresBefore / (before * before));
}

double Film::errorScale() const {
    if (passes_ < 2) return Unknown;
    if (meaning_ == PassWeight::Samples) return 1.0 / (double(passes_ - 1) * weight_);
    return squaredWeights_ / (weight_ * (weight_ * weight_ - squaredWeights_));
}

Image Film::imageOf(const float* values) const {
    Image image(width_, height_);
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = rgb(values + i * size_t(contents_.channels));
    return image;
}

Image Film::imageOf(int frame, Part part) const {
    Image image(width_, height_);
    for (int y = 0; y < height_; ++y)
        for (size_t tile = 0; tile < tilesInRow_; ++tile) {
            const float* found = tiles_.find(row(frame, y) * tilesInRow_ + tile);
            const int first = int(tile << TileShift), end = std::min(first + int(TilePixels), width_);
            for (int x = first; found && x < end; ++x)
                image.at(x, y) = rgb(found + size_t(part) * tileValues() + inTile(x));
        }
    return image;
}

Image Film::errorImage(Image moments) const {
    const double scale = errorScale();
    for (Rgb& pixel : moments.pixels)
        for (int c = 0; c < 3; ++c) pixel[c] = float(std::sqrt(std::max(double(pixel[c]), 0.0) * scale));
    return moments;
}

Image Film::mean(int frame) const {
    return imageOf(frame, Mean);
}

Image Film::standardError(int frame) const {
    if (contents_.moments) return errorImage(imageOf(frame, Moment));
    Image unknown(width_, height_);
    std::fill(unknown.pixels.begin(), unknown.pixels.end(), Rgb(float(Unknown)));
    return unknown;
}

Image Film::meanOverFrames() const {
    return frames_ > 1 ? imageOf(totalMean_.data()) : mean(0);
}

Image Film::standardErrorOverFrames() const {
    return frames_ > 1 ? errorImage(imageOf(totalMoment2_.data())) : standardError(0);
}

double Film::meanSquaredError() const {
    const double values = double(lit_.size()) * double(rowValues());
    return values > 0.0 ? errorScale() * moment2Sum_ / values : 0.0;
}

size_t Film::memoryBytes() const {
    const size_t floats = 2 * blocks_.size() + totalMean_.size() + totalMoment2_.size() + batches_.means().size();
    return tiles_.bytes() + floats * sizeof(float) + touched_.size() + lit_.size() + confidence_.memoryBytes();
}

} // namespace tungsten
