#include "tungsten/film/Film.h"

#include "tungsten/core/Errors.h"
#include "tungsten/film/MeanUpdate.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tungsten {

namespace {

constexpr double LargestFilmBytes = 16.0 * 1024 * 1024 * 1024;
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();
/// Of a function of the values.
template <typename Function>
double meanOf(const LazyArray& values, const Function& function) {
    double sum = 0.0;
    for (const float value : values) sum += function(double(value));
    return values.empty() ? 0.0 : sum / double(values.size());
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
    mean_ = LazyArray(values * size_t(frames));
    pass_ = LazyArray(values * size_t(frames));
    if (contents.batches > 0) batches_ = PassBatches(width, height, frames, contents);
    if (contents.moments) moment2_ = LazyArray(values * size_t(frames));
    touched_.assign(size_t(height) * size_t(frames), 0);
    lit_ = touched_;
    if (frames > 1) {
        totalMean_.assign(values, 0.0f);
        totalMoment2_ = totalMean_;
    }
}

double Film::memoryFor(int width, int height, int frames, FilmContents contents) {
    return double(width) * double(height) * (double(frames) * contents.floats() + 2.0 * contents.channels) *
               double(sizeof(float)) +
           PassBatches::memoryFor(width, height, frames, contents);
}

void Film::beginPass() {
    const size_t values = size_t(width_) * size_t(contents_.channels);
    tbb::parallel_for(size_t(0), touched_.size(), [&](size_t row) {
        if (touched_[row] != 0) std::fill_n(pass_.begin() + ptrdiff_t(row * values), values, 0.0f);
        touched_[row] = 0;
    });
}

void Film::setPassRow(size_t row, const float* values) {
    std::copy_n(values, rowValues(), pass_.begin() + ptrdiff_t(row * rowValues()));
    touched_[row] = 1;
}

void Film::setPassValues(const std::vector<float>& values) {
    for (size_t row = 0; row < touched_.size(); ++row) {
        const float* begin = values.data() + row * rowValues();
        if (!std::all_of(begin, begin + rowValues(), [](float value) { return value == 0.0f; })) setPassRow(row, begin);
    }
}

double Film::foldRow(size_t row, double weight, float* sums, uint64_t& nonFinite) {
    const size_t values = rowValues(), first = row * values;
    float *pass = pass_.data() + first, *means = mean_.data() + first;
    if (touched_[row] != 0) {
        lit_[row] = 1;
        for (size_t x = 0; x < values; x += size_t(contents_.channels))
            if (!isFinite(rgb(pass + x))) {
                ++nonFinite;
                std::fill_n(pass + x, contents_.channels, 0.0f);
            }
    } else if (lit_[row] == 0) {
        return 0.0;
    }
    double deviation = 0.0;
    for (size_t i = 0; i < values; ++i) {
        const uint64_t bits = evenBits(passes_, first + i);
        deviation += contents_.moments ? foldInto(pass[i], weight, weight_, bits, means[i], moment2_[first + i])
                                       : foldInto(pass[i], weight, weight_, bits, means[i]);
        sums[i] += pass[i];
    }
    return deviation;
}

FoldedPass Film::foldRows(double weight, int from, int end) {
    const size_t values = rowValues();
    FoldedPass folded{weight, weight_, squaredWeights_, std::vector<double>(size_t(end - from), 0.0)};
    std::vector<uint64_t> rowNonFinite(folded.deviations.size(), 0);
    tbb::parallel_for(size_t(from), size_t(end), [&](size_t y) {
        std::vector<float> sums(values, 0.0f);
        const size_t at = y - size_t(from);
        for (int frame = 0; frame < frames_; ++frame)
            folded.deviations[at] += foldRow(row(frame, int(y)), weight, sums.data(), rowNonFinite[at]);
        if (frames_ == 1) return;
        for (size_t i = 0; i < values; ++i)
            foldInto(sums[i] / float(frames_), weight, weight_, evenBits(passes_, ~uint64_t(y * values + i)),
                     totalMean_[y * values + i], totalMoment2_[y * values + i]);
    });
    for (const uint64_t count : rowNonFinite) nonFinite_ += count;
    batches_.fold(passes_, weight, pass_, lit_, from, end);
    batches_.nextPass(passes_, weight);
    weight_ += weight;
    squaredWeights_ += weight * weight;
    ++passes_;
    return folded;
}

void Film::settle(const FoldedPass& pass) {
    const double deviation = std::accumulate(pass.deviations.begin(), pass.deviations.end(), 0.0);
    if (pass.weightBefore > 0.0) scatter_.add(variance(deviation, pass));
    moment2Sum_ += deviation;
}

double Film::variance(double deviation, const FoldedPass& pass) const {
    // The squared distance of the pass from the mean before it, over what is expected of it with a variance of 1.
    if (meaning_ == PassWeight::Samples) return deviation;
    const double before = pass.weightBefore;
    const double fromMean = deviation * (before + pass.weight) / (before * pass.weight);
    return fromMean / (1.0 + pass.squaresBefore / (before * before));
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

Image Film::errorImage(const float* moments) const {
    Image image = imageOf(moments);
    const double scale = errorScale();
    for (Rgb& pixel : image.pixels)
        for (int c = 0; c < 3; ++c) pixel[c] = float(std::sqrt(std::max(double(pixel[c]), 0.0) * scale));
    return image;
}

Image Film::mean(int frame) const {
    return imageOf(mean_.data() + offset(frame, 0, 0));
}

Image Film::standardError(int frame) const {
    if (contents_.moments) return errorImage(moment2_.data() + offset(frame, 0, 0));
    Image unknown(width_, height_);
    std::fill(unknown.pixels.begin(), unknown.pixels.end(), Rgb(float(Unknown)));
    return unknown;
}

Image Film::meanOverFrames() const {
    return frames_ > 1 ? imageOf(totalMean_.data()) : mean(0);
}

Image Film::standardErrorOverFrames() const {
    return frames_ > 1 ? errorImage(totalMoment2_.data()) : standardError(0);
}

double Film::meanValue() const {
    return meanOf(mean_, [](double value) { return value; });
}

double Film::meanSquare() const {
    return meanOf(mean_, [](double value) { return value * value; });
}

double Film::meanSquaredError() const {
    return mean_.empty() ? 0.0 : errorScale() * moment2Sum_ / double(mean_.size());
}

double Film::relativeStandardError() const {
    const double mean = meanValue();
    return mean > 0.0 ? std::sqrt(meanSquaredError()) / mean : Unknown;
}

size_t Film::memoryBytes() const {
    const auto lit = size_t(std::count(lit_.begin(), lit_.end(), uint8_t(1)));
    const size_t floats = lit * size_t(width_) * size_t(contents_.floats()) + totalMean_.size() + totalMoment2_.size() +
                          batches_.means().size();
    return floats * sizeof(float) + touched_.size() + lit_.size() + scatter_.memoryBytes();
}

} // namespace tungsten
