#pragma once
// How well a render knows its own error: the spread of what single passes deviate from the mean.

#include <cstddef>
#include <iosfwd>
#include <vector>

namespace tungsten {

/// Of the squared deviations of passes, each an estimate of the variance of one pass and summed over all pixels. Their
/// mean over the number of passes is the squared error to be expected; it may be too low, and so may chance make the
/// error that was made larger than it (the fewer pixels are independent the more):
///
///     squared error <= expected (1 + z sqrt(v / n + s)),
///
/// v: relative variance of the deviations over n passes (rare bright samples make it large); s: the same by quartiles,
/// which rare samples do not reach; an even, bell-shaped noise of k independent pixels has s = 2 / k. Measured:
/// benchmarks/results/promise/README.md.
class PassScatter {
  public:
    /// Standard deviations of a one-sided confidence of 97.7 %, on the safe side of the 95 % that is told.
    static constexpr double Deviations = 2.0;
    /// More values are not kept: pairs are then averaged.
    static constexpr size_t MostGroups = 4096;

    void add(double squaredDeviation);
    /// Factor >= 1 from the expected error (not squared) to its bound; NaN with fewer than four values.
    [[nodiscard]] double boundFactor() const;
    [[nodiscard]] size_t memoryBytes() const { return groups_.capacity() * sizeof(double); }

    /// Exact binary state; read() leaves a stream that failed to its caller.
    void write(std::ostream& out) const;
    void read(std::istream& in);

  private:
    std::vector<double> groups_; ///< means of `span_` passes' each
    size_t span_ = 1, inGroup_ = 0;
    double sum_ = 0.0; ///< of the group that is not full
};

} // namespace tungsten
