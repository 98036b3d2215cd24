#pragma once
// Discrete distributions sampled by inversion of the cumulative sum.

#include "tungsten/core/Types.h"

#include <cstddef>
#include <vector>

namespace tungsten {

/// Probabilities proportional to non-negative weights. All weights zero: uniform.
class Distribution1D {
  public:
    Distribution1D() = default;
    explicit Distribution1D(const std::vector<float>& weights);

    struct Sample {
        size_t index;
        float probability; ///< of `index`
        float remapped;    ///< the part of u left inside the chosen cell, uniform in [0, 1)
    };
    [[nodiscard]] Sample sample(float u) const;
    [[nodiscard]] float probability(size_t index) const;
    [[nodiscard]] size_t size() const { return cumulative_.empty() ? 0 : cumulative_.size() - 1; }
    /// Sum of the weights.
    [[nodiscard]] double total() const { return total_; }

  private:
    std::vector<double> cumulative_; ///< normalised, size() + 1 entries
    double total_ = 0.0;
};

/// Piecewise-constant density over the unit square (rows × columns cells).
class Distribution2D {
  public:
    Distribution2D() = default;
    Distribution2D(const std::vector<float>& weights, int columns, int rows);

    /// A point in [0, 1)² (x along columns) and its density per unit square area.
    [[nodiscard]] Vec2f sample(const Vec2f& u, float& pdf) const;
    [[nodiscard]] float pdf(const Vec2f& point) const;

  private:
    int columns_ = 0, rows_ = 0;
    Distribution1D marginal_;
    std::vector<Distribution1D> conditional_;
};

} // namespace tungsten
