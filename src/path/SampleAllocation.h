#pragma once
// How many samples each pixel gets: more where its paths vary much for what they cost (Neyman's allocation), measured
// by a pilot before the first pass (docs/method.md, section 11).

#include "tungsten/core/Types.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tungsten::path {

/// Density of samples over the image, relative to an even one: 2^k and 3/2 2^k between Least and Most, with a
/// cost-weighted mean of about 1, so that a pass takes as long as an even one. Even until something was measured.
class SampleAllocation {
  public:
    /// No pixel gets less than this part of its even share: its variance is at most the inverse times that of even
    /// samples, whatever the pilot has missed. Passes of fewer samples a pixel than FewestSamples stay even, since some
    /// pixels would have none.
    static constexpr float Least = 0.25f, Most = 32.0f;
    static constexpr uint32_t FewestSamples = 4;

    SampleAllocation() = default;
    /// For images of this size.
    explicit SampleAllocation(Vec2i resolution);

    /// Blocks of pixels that are measured as one, and a pixel of a block at a random place.
    [[nodiscard]] size_t blocks() const { return size_t(grid_.x) * size_t(grid_.y); }
    [[nodiscard]] Vec2i pixelOf(size_t block, float u, float v) const;
    /// What two independent paths of a pixel differ by, half of the squares summed over frames, and what they cost.
    void tell(size_t block, double variance, double cost);
    /// Makes the densities of what was told. They must prove themselves: densities by either half of the pairs are
    /// judged by the other half, over neighbourhoods of different width. The larger variance x cost of the two, with
    /// what they differ by, must be less than that of even samples, and the least is taken.
    void choose();

    /// Variance of the image times its cost as the pairs have it, up to a factor, with samples shared out or even; and
    /// the relative standard error of the variance of even ones.
    [[nodiscard]] double varianceTimesCost() const { return part_ * varianceTimesCostOfEven(); }
    [[nodiscard]] double varianceTimesCostOfEven() const;
    [[nodiscard]] double relativeError() const;
    [[nodiscard]] double pairs() const { return total().pairs; }

    /// Samples [first, first + count) of a pixel in a pass that has samples [first, first + count) of an even image.
    struct Samples {
        uint32_t first, count;
    };
    [[nodiscard]] Samples of(int x, int y, uint64_t first, uint32_t count) const;

  private:
    struct Block {
        double variance = 0.0, cost = 0.0, pairs = 0.0;
    };
    using Blocks = std::vector<Block>;
    using Densities = std::vector<float>;

    [[nodiscard]] Block total() const;
    /// Means of each block's neighbourhood, so wide that so many pairs are in it.
    [[nodiscard]] Blocks smoothed(const Blocks& told, double pairs) const;
    [[nodiscard]] Densities densitiesBy(const Blocks& told, double pairs) const;

    Vec2i resolution_{0, 0}, grid_{0, 0};
    std::array<Blocks, 2> halves_;
    Densities densities_;  ///< by block; empty: even
    double part_ = 1.0;    ///< variance x cost over that of even samples
    double squares_ = 0.0; ///< of the variances that were told
};

} // namespace tungsten::path
