#include "tungsten/film/Film.h"

#include "tungsten/core/Errors.h"

#include <tbb/parallel_for.h>

#include <cstring>
#include <istream>
#include <limits>
#include <numeric>
#include <ostream>

namespace tungsten {

namespace {

constexpr double LargestFilmBytes = 16.0 * 1024 * 1024 * 1024;
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();
constexpr char Magic[8] = {'T', 'F', 'I', 'L', 'M', '0', '0', '3'};

struct StateHeader {
    char magic[8];
    int32_t width, height, frames;
    uint32_t passes;
    double weight, squaredWeights;
    uint64_t nonFinite;
};

/// West's update of a weighted mean and sum of squared deviations, per channel. Returns what it adds to the sum.
double fold(float value, double weight, double totalBefore, float& mean, float& moment2) {
    const double delta = double(value) - double(mean);
    const double share = delta * weight / (totalBefore + weight);
    const double deviation = totalBefore * delta * share;
    mean = float(double(mean) + share);
    moment2 = float(double(moment2) + deviation);
    return deviation;
}

double fold(const Rgb& value, double weight, double totalBefore, Rgb& mean, Rgb& moment2) {
    double deviation = 0.0;
    for (int c = 0; c < 3; ++c) deviation += fold(value[c], weight, totalBefore, mean[c], moment2[c]);
    return deviation;
}

/// Standard error: the root of the second moment times `scale`.
Image errorImage(int width, int height, const Rgb* moment2, double scale) {
    Image image(width, height);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) image.pixels[i][c] = float(std::sqrt(std::max(double(moment2[i][c]), 0.0) * scale));
    return image;
}

Image imageOf(int width, int height, const Rgb* pixels) {
    Image image(width, height);
    std::copy(pixels, pixels + image.pixels.size(), image.pixels.begin());
    return image;
}

/// Over pixels and channels, of a function of their values.
template <typename Function>
double meanOf(const std::vector<Rgb>& pixels, const Function& function) {
    double sum = 0.0;
    for (const Rgb& pixel : pixels)
        for (int c = 0; c < 3; ++c) sum += function(pixel[c]);
    return pixels.empty() ? 0.0 : sum / (3.0 * double(pixels.size()));
}

void writeArray(std::ostream& out, const std::vector<Rgb>& values) {
    out.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(Rgb)));
}

void readArray(std::istream& in, std::vector<Rgb>& values) {
    in.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(Rgb)));
}

} // namespace

Film::Film(int width, int height, int frames, PassWeight meaning)
    : width_(width), height_(height), frames_(frames), meaning_(meaning) {
    const double bytes = memoryFor(width, height, frames);
    if (bytes > LargestFilmBytes)
        throw InputError("film", std::to_string(width) + "x" + std::to_string(height) + " pixels in " +
                                     std::to_string(frames) + " frames would take " +
                                     std::to_string(int(bytes / (1024.0 * 1024 * 1024))) +
                                     " GiB; the limit is 16 GiB: use fewer frames or a smaller --resolution");
    const size_t pixels = size_t(width) * size_t(height);
    mean_.assign(pixels * size_t(frames), Rgb(0.0f));
    moment2_ = mean_;
    pass_ = mean_;
    if (frames > 1) {
        totalMean_.assign(pixels, Rgb(0.0f));
        totalMoment2_ = totalMean_;
    }
}

double Film::memoryFor(int width, int height, int frames) {
    return double(width) * double(height) * (double(frames) * 3.0 + 2.0) * double(sizeof(Rgb));
}

void Film::beginPass() {
    std::fill(pass_.begin(), pass_.end(), Rgb(0.0f));
}

void Film::endPass(double weight) {
    const size_t pixels = size_t(width_) * size_t(height_);
    const double before = weight_;
    std::vector<uint32_t> rowNonFinite(size_t(height_), 0);
    std::vector<double> rowDeviation(size_t(height_), 0.0);
    tbb::parallel_for(size_t(0), size_t(height_), [&](size_t row) {
        for (size_t pixel = row * size_t(width_); pixel < (row + 1) * size_t(width_); ++pixel) {
            Rgb sum(0.0f);
            for (size_t frame = 0; frame < size_t(frames_); ++frame) {
                const size_t i = frame * pixels + pixel;
                if (!isFinite(pass_[i])) {
                    ++rowNonFinite[row];
                    pass_[i] = Rgb(0.0f);
                }
                rowDeviation[row] += fold(pass_[i], weight, before, mean_[i], moment2_[i]);
                sum += pass_[i];
            }
            if (frames_ > 1) fold(sum / float(frames_), weight, before, totalMean_[pixel], totalMoment2_[pixel]);
        }
    });
    for (const uint32_t count : rowNonFinite) nonFinite_ += count;
    if (passes_ > 0) scatter_.add(variance(std::accumulate(rowDeviation.begin(), rowDeviation.end(), 0.0), weight));
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

Image Film::mean(int frame) const {
    return imageOf(width_, height_, mean_.data() + size_t(frame) * size_t(width_) * size_t(height_));
}

Image Film::standardError(int frame) const {
    const Rgb* moments = moment2_.data() + size_t(frame) * size_t(width_) * size_t(height_);
    return errorImage(width_, height_, moments, errorScale());
}

Image Film::meanOverFrames() const {
    return frames_ > 1 ? imageOf(width_, height_, totalMean_.data()) : mean(0);
}

Image Film::standardErrorOverFrames() const {
    return frames_ > 1 ? errorImage(width_, height_, totalMoment2_.data(), errorScale()) : standardError(0);
}

double Film::meanValue() const {
    return meanOf(mean_, [](float value) { return double(value); });
}

double Film::meanSquare() const {
    return meanOf(mean_, [](float value) { return double(value) * double(value); });
}

double Film::meanSquaredError() const {
    return errorScale() * meanOf(moment2_, [](float value) { return double(value); });
}

double Film::relativeStandardError() const {
    const double mean = meanValue();
    return mean > 0.0 ? std::sqrt(meanSquaredError()) / mean : Unknown;
}

size_t Film::memoryBytes() const {
    return (mean_.size() + moment2_.size() + pass_.size() + totalMean_.size() + totalMoment2_.size()) * sizeof(Rgb) +
           scatter_.memoryBytes();
}

void Film::write(std::ostream& out) const {
    StateHeader header{{}, width_, height_, frames_, passes_, weight_, squaredWeights_, nonFinite_};
    std::memcpy(header.magic, Magic, sizeof Magic);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    for (const auto* values : {&mean_, &moment2_, &totalMean_, &totalMoment2_}) writeArray(out, *values);
    scatter_.write(out);
}

void Film::read(std::istream& in, const std::string& fileName) {
    StateHeader header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!in || std::memcmp(header.magic, Magic, sizeof Magic) != 0)
        throw InputError(fileName, "not a saved render state (or truncated)");
    if (header.width != width_ || header.height != height_ || header.frames != frames_)
        throw InputError(fileName, "the saved state has " + std::to_string(header.width) + "x" +
                                       std::to_string(header.height) + " pixels in " + std::to_string(header.frames) +
                                       " frames, this render " + std::to_string(width_) + "x" +
                                       std::to_string(height_) + " in " + std::to_string(frames_));
    Film loaded(width_, height_, frames_, meaning_);
    for (auto* values : {&loaded.mean_, &loaded.moment2_, &loaded.totalMean_, &loaded.totalMoment2_})
        readArray(in, *values);
    loaded.scatter_.read(in);
    if (!in) throw InputError(fileName, "the saved render state is truncated");
    loaded.passes_ = header.passes;
    loaded.weight_ = header.weight;
    loaded.squaredWeights_ = header.squaredWeights;
    loaded.nonFinite_ = header.nonFinite;
    *this = std::move(loaded);
}

} // namespace tungsten
