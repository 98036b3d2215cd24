#pragma once
// The accumulator: frames x pixels, with the mean and second moment of pass images, so every render knows its standard
// error.

#include "tungsten/core/Types.h"
#include "tungsten/film/PassScatter.h"

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace tungsten {

/// Row-major RGB image, row 0 at the top.
struct Image {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(size_t(w) * size_t(h), Rgb(0.0f)) {}
    [[nodiscard]] Rgb& at(int x, int y) { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
    [[nodiscard]] const Rgb& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
};

/// What the weight of a pass says.
enum class PassWeight {
    Samples, ///< the pass is the mean of so many samples: its variance is inversely proportional to them
    Repeats, ///< the pass stands for so many like it; all have one variance
};

/// Progressive estimate of every pixel of every frame. A pass adds one image per frame; passes may weigh differently
/// (by samples per pixel). Mean and second moment follow West (1979), so adding in the same order gives the same bits.
class Film {
  public:
    Film() = default;
    Film(int width, int height, int frames, PassWeight meaning = PassWeight::Samples);
    /// Bytes that such a film takes.
    [[nodiscard]] static double memoryFor(int width, int height, int frames);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int frames() const { return frames_; }
    [[nodiscard]] uint32_t passes() const { return passes_; }
    [[nodiscard]] double totalWeight() const { return weight_; }

    /// The image of the pass in progress (zeroed by beginPass): integrators write each pixel's mean over the pass's
    /// samples.
    void beginPass();
    [[nodiscard]] Rgb& passPixel(int frame, int x, int y) {
        return pass_[(size_t(frame) * size_t(height_) + size_t(y)) * size_t(width_) + size_t(x)];
    }
    /// Folds the pass image in with the given weight (> 0). Non-finite pixels are counted, and replaced by 0.
    void endPass(double weight);
    [[nodiscard]] uint64_t nonFiniteSamples() const { return nonFinite_; }
    void countNonFinite(uint64_t n) { nonFinite_ += n; }

    [[nodiscard]] Image mean(int frame) const;
    /// Standard error of mean(frame) per pixel; NaN while it is unknown, with fewer than two passes.
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

  private:
    /// From a second moment to the squared standard error; NaN while it is unknown.
    [[nodiscard]] double errorScale() const;
    /// An estimate of the variance of one pass from what it adds to the second moment.
    [[nodiscard]] double variance(double deviation, double weight) const;

    int width_ = 0, height_ = 0, frames_ = 0;
    PassWeight meaning_ = PassWeight::Samples;
    uint32_t passes_ = 0;
    double weight_ = 0.0, squaredWeights_ = 0.0; ///< sums over the passes
    uint64_t nonFinite_ = 0;
    PassScatter scatter_;
    std::vector<Rgb> mean_, moment2_, pass_;
    std::vector<Rgb> totalMean_, totalMoment2_; ///< of the mean over frames (frames > 1)
};

} // namespace tungsten
