#include "tungsten/film/Film.h"

#include <bit>

#include "tungsten/core/Errors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <istream>
#include <limits>
#include <numeric>
#include <ostream>

namespace tungsten {

namespace {

constexpr double LargestFilmBytes = 16.0 * 1024 * 1024 * 1024;
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();
constexpr char Magic[8] = {'T', 'F', 'I', 'L', 'M', '0', '0', '4'};

struct StateHeader {
    char magic[8];
    int32_t width, height, frames, channels;
    uint32_t moments, passes;
    double weight, squaredWeights, moment2Sum;
    uint64_t nonFinite;
};

/// Bits below a float's mantissa in a double's.
constexpr int BelowFloat = 29;

/// Even bits that depend on the pass and the place of the value alone.
uint64_t evenBits(uint64_t pass, uint64_t place) {
    uint64_t bits = (place + 1) * 0x9E3779B97F4A7C15u ^ (pass + 1) * 0xD1B54A32D192ED03u;
    bits = (bits ^ (bits >> 32)) * 0xBF58476D1CE4E5B9u;
    return bits ^ (bits >> 29);
}

/// One of the two neighbouring floats, the farther from 0 with the odds of the remainder: a mean of many passes moves
/// by less than its last bit, and what is rounded to the nearest is lost, the small shares rather than the large ones.
float roundEvenly(double value, uint64_t bits) {
    constexpr uint64_t Mask = (uint64_t(1) << BelowFloat) - 1;
    return float(std::bit_cast<double>((std::bit_cast<uint64_t>(value) + (bits & Mask)) & ~Mask));
}

/// West's update of a weighted mean. Returns what it adds to the sum of squared deviations.
double fold(float value, double weight, double totalBefore, uint64_t bits, float& mean) {
    const double delta = double(value) - double(mean);
    const double share = delta * weight / (totalBefore + weight);
    mean = roundEvenly(double(mean) + share, bits);
    return totalBefore * delta * share;
}

double fold(float value, double weight, double totalBefore, uint64_t bits, float& mean, float& moment2) {
    const double deviation = fold(value, weight, totalBefore, bits, mean);
    moment2 = roundEvenly(double(moment2) + deviation, bits >> BelowFloat);
    return deviation;
}

/// Of a function of the values.
template <typename Function>
double meanOf(const LazyArray& values, const Function& function) {
    double sum = 0.0;
    for (const float value : values) sum += function(double(value));
    return values.empty() ? 0.0 : sum / double(values.size());
}

template <typename Values>
void writeArray(std::ostream& out, const Values& values, size_t first, size_t count) {
    out.write(reinterpret_cast<const char*>(values.data() + first), std::streamsize(count * sizeof(values[0])));
}

template <typename Values>
void readArray(std::istream& in, Values& values, size_t first, size_t count) {
    in.read(reinterpret_cast<char*>(values.data() + first), std::streamsize(count * sizeof(values[0])));
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
           double(sizeof(float));
}

void Film::beginPass() {
    const size_t values = size_t(width_) * size_t(contents_.channels);
    tbb::parallel_for(size_t(0), touched_.size(), [&](size_t row) {
        if (touched_[row] != 0) std::fill_n(pass_.begin() + ptrdiff_t(row * values), values, 0.0f);
        touched_[row] = 0;
    });
}

void Film::setPassValues(const std::vector<float>& values) {
    const auto rowValues = ptrdiff_t(width_ * contents_.channels);
    for (size_t row = 0; row < touched_.size(); ++row) {
        const auto begin = values.begin() + ptrdiff_t(row) * rowValues, end = begin + rowValues;
        if (std::all_of(begin, end, [](float value) { return value == 0.0f; })) continue;
        std::copy(begin, end, pass_.begin() + ptrdiff_t(row) * rowValues);
        touched_[row] = 1;
    }
}

double Film::foldRow(size_t row, double weight, float* sums, uint64_t& nonFinite) {
    const size_t values = size_t(width_) * size_t(contents_.channels), first = row * values;
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
        deviation += contents_.moments ? fold(pass[i], weight, weight_, bits, means[i], moment2_[first + i])
                                       : fold(pass[i], weight, weight_, bits, means[i]);
        sums[i] += pass[i];
    }
    return deviation;
}

void Film::endPass(double weight) {
    const size_t values = size_t(width_) * size_t(contents_.channels);
    std::vector<uint64_t> rowNonFinite(size_t(height_), 0);
    std::vector<double> rowDeviation(size_t(height_), 0.0);
    tbb::parallel_for(size_t(0), size_t(height_), [&](size_t y) {
        std::vector<float> sums(values, 0.0f);
        for (int frame = 0; frame < frames_; ++frame)
            rowDeviation[y] += foldRow(row(frame, int(y)), weight, sums.data(), rowNonFinite[y]);
        if (frames_ == 1) return;
        for (size_t i = 0; i < values; ++i)
            fold(sums[i] / float(frames_), weight, weight_, evenBits(passes_, ~uint64_t(y * values + i)),
                 totalMean_[y * values + i], totalMoment2_[y * values + i]);
    });
    for (const uint64_t count : rowNonFinite) nonFinite_ += count;
    const double deviation = std::accumulate(rowDeviation.begin(), rowDeviation.end(), 0.0);
    if (passes_ > 0) scatter_.add(variance(deviation, weight));
    moment2Sum_ += deviation;
    weight_ += weight;
    squaredWeights_ += weight * weight;
    ++passes_;
}

double Film::variance(double deviation, double weight) const {
    // The squared distance of the pass from the mean before it, over what is expected of it with a variance of 1.
    if (meaning_ == PassWeight::Samples) return deviation;
    const double fromMean = deviation * (weight_ + weight) / (weight_ * weight);
    return fromMean / (1.0 + squaredWeights_ / (weight_ * weight_));
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
    const size_t floats = lit * size_t(width_) * size_t(contents_.floats()) + totalMean_.size() + totalMoment2_.size();
    return floats * sizeof(float) + touched_.size() + lit_.size() + scatter_.memoryBytes();
}

void Film::write(std::ostream& out) const {
    StateHeader header{{},      width_,  height_,         frames_,     contents_.channels, contents_.moments,
                       passes_, weight_, squaredWeights_, moment2Sum_, nonFinite_};
    std::memcpy(header.magic, Magic, sizeof Magic);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    const size_t values = size_t(width_) * size_t(contents_.channels);
    writeArray(out, lit_, 0, lit_.size());
    for (size_t row = 0; row < lit_.size(); ++row) {
        if (lit_[row] == 0) continue;
        writeArray(out, mean_, row * values, values);
        if (contents_.moments) writeArray(out, moment2_, row * values, values);
    }
    for (const auto* total : {&totalMean_, &totalMoment2_}) writeArray(out, *total, 0, total->size());
    scatter_.write(out);
}

void Film::read(std::istream& in, const std::string& fileName) {
    StateHeader header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!in || std::memcmp(header.magic, Magic, sizeof Magic) != 0)
        throw InputError(fileName, "not a saved render state (or truncated)");
    const auto text = [](int width, int height, int frames, int channels, bool moments) {
        return std::to_string(width) + "x" + std::to_string(height) + " pixels in " + std::to_string(frames) +
               " frames of " + std::to_string(channels) + (channels == 1 ? " channel" : " channels") +
               (moments ? "" : " without moments");
    };
    const std::string saved = text(header.width, header.height, header.frames, header.channels, header.moments != 0);
    const std::string mine = text(width_, height_, frames_, contents_.channels, contents_.moments);
    if (saved != mine) throw InputError(fileName, "the saved state has " + saved + ", this render " + mine);
    Film loaded(width_, height_, frames_, contents_, meaning_);
    const size_t values = size_t(width_) * size_t(contents_.channels);
    readArray(in, loaded.lit_, 0, loaded.lit_.size());
    for (size_t row = 0; row < loaded.lit_.size(); ++row) {
        if (loaded.lit_[row] == 0) continue;
        readArray(in, loaded.mean_, row * values, values);
        if (contents_.moments) readArray(in, loaded.moment2_, row * values, values);
    }
    for (auto* total : {&loaded.totalMean_, &loaded.totalMoment2_}) readArray(in, *total, 0, total->size());
    loaded.scatter_.read(in);
    if (!in) throw InputError(fileName, "the saved render state is truncated");
    loaded.passes_ = header.passes;
    loaded.weight_ = header.weight;
    loaded.squaredWeights_ = header.squaredWeights;
    loaded.moment2Sum_ = header.moment2Sum;
    loaded.nonFinite_ = header.nonFinite;
    *this = std::move(loaded);
}

} // namespace tungsten
