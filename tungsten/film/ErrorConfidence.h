#pragma once
// How well a render knows its own error: the spread of what single passes deviate from the mean.

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <vector>

namespace tungsten {

/// What a pass deviates from the mean of those before it, over all or some pixels: the sum of squares, scaled so that
/// its expectation is a pass's variance. Where the pass ends a group of passes: of the group's deviations, summed over
/// blocks of pixels, the sum of squares, and the product with those of the group before.
struct PassSpread {
    double squares = 0.0, blocks = 0.0, product = 0.0;
};

/// Of the squared deviations of passes, each an estimate of the variance of one pass and summed over all pixels. Their
/// mean over the number of passes is the squared error to be expected; it may be too low, and so may chance make the
/// error that was made larger than it (the fewer pixels are independent the more):
///
///     squared error <= expected (1 + z sqrt(v / n + s)),
///
/// v: relative variance of the squared deviations over n passes (rare bright samples make it large); s: that of the
/// squared error, of n passes' mean. With covariance C of the values of a pass it is 2 tr C^2 / (tr C)^2, 2 / k for k
/// independent ones, and v / n more. The deviations x, y of two passes tell it by 2 E (x . y)^2 / E |x|^2 |y|^2, those
/// of two groups of passes however rare the passes are that deviate most. Sums over blocks stand for their values,
/// which are no fewer independent numbers; where v is less, it is taken, and with few passes v by quartiles, which rare
/// samples do not reach. Measured: benchmarks/results/promise/README.md.
class ErrorConfidence {
  public:
    /// Standard deviations of a one-sided confidence of 97.7 %, on the safe side of the 95 % that is told.
    static constexpr double Deviations = 2.0;
    /// More values are not kept: pairs are then averaged.
    static constexpr size_t MostGroups = 4096;

    /// Deviations of the passes from the second on (pass 1), in their order.
    void add(uint32_t pass, const PassSpread& deviation);
    /// Passes of the group that ends with this one, between 32 and 64 groups in all; 0 where none ends.
    [[nodiscard]] static uint32_t groupEndingWith(uint32_t pass);
    /// Factor >= 1 from the expected error (not squared) to its bound; NaN with fewer than four values.
    [[nodiscard]] double boundFactor() const;
    [[nodiscard]] size_t memoryBytes() const { return groups_.capacity() * sizeof(double); }

    /// Exact binary state; read() leaves a stream that failed to its caller.
    void write(std::ostream& out) const;
    void read(std::istream& in);

  private:
    /// An upper bound (2 standard errors) of 2 tr C^2 / (tr C)^2; infinite with few passes.
    [[nodiscard]] double sharedVariance() const;

    std::vector<double> groups_; ///< means of `span_` passes' each
    size_t span_ = 1, inGroup_ = 0;
    double sum_ = 0.0;        ///< of the group that is not full
    double lastBlocks_ = 0.0; ///< PassSpread::blocks of the last group
    /// Of groups of w passes with q = (x . y / w)^2 and d = |x|^2 |y|^2 / w^2: sums of w, w^2, w q, w d, w^2 q^2, w^2 q
    /// d, w^2 d^2.
    std::array<double, 7> products_{};
};

} // namespace tungsten
