#pragma once
// The sensor's response W(T) to the time of arrival, when it is more than a box.

#include <cstddef>
#include <vector>

namespace darts {

/// A piecewise linear density over time, normalised to integral 1: a pixel is the integral of L(T) W(T) dT. Evaluated,
/// and sampled inside any interval by inverting its distribution. All times in one unit, in double.
class TemporalResponse {
  public:
    /// Constant on [begin, end).
    static TemporalResponse box(double begin, double end);
    /// exp(-(T - center)^2 / (2 sigma^2)), cut at 4 sigma, as 65 linear pieces' ends (within 1e-3 of its maximum).
    static TemporalResponse gaussian(double center, double sigma);
    /// Linear between (times[i], values[i]); times increase, values are not negative and not all zero, at least two.
    /// Throws std::invalid_argument otherwise.
    static TemporalResponse tabulated(std::vector<double> times, std::vector<double> values);

    /// Density of the sum of two times drawn independently: their convolution, exact where pieces meet and linear
    /// between.
    static TemporalResponse convolved(const TemporalResponse& a, const TemporalResponse& b);

    [[nodiscard]] double begin() const { return times_.front(); }
    [[nodiscard]] double end() const { return times_.back(); }
    /// Density per time; 0 outside [begin, end).
    [[nodiscard]] double pdf(double time) const;
    /// Integral of the density from begin() to `time`.
    [[nodiscard]] double distribution(double time) const;
    /// Inverse of distribution(), u in [0, 1].
    [[nodiscard]] double quantile(double u) const;

  private:
    TemporalResponse(std::vector<double> times, std::vector<double> values);
    [[nodiscard]] double convolvedPdf(const TemporalResponse& other, double time) const;
    [[nodiscard]] std::size_t piece(const std::vector<double>& grid, double value) const;

    std::vector<double> times_, densities_, distribution_;
};

} // namespace darts
