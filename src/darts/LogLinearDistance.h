#pragma once
// Distances by a density that is known: its logarithm is linear between a few nodes, at which importance is evaluated.

#include "darts/CandidateImportance.h"

#include <array>

namespace darts {

/// Density per length on [0, bound), in proportion to importance (of candidates, DistanceSampler) at its nodes and
/// log-linear between them:
///   p(d) = e^{L_i + (L_{i+1} - L_i) (d - b_i) / (b_{i+1} - b_i)} / sum m,
///   m_i = (b_{i+1} - b_i) (e^{L_{i+1}} - e^{L_i}) / (L_{i+1} - L_i).
/// Nodes are quantiles of the free flight and of a uniform distance, and where the part of the gate that is still
/// reachable begins to shrink. Positive everywhere; one random number a draw.
class LogLinearDistance {
  public:
    static constexpr int Nodes = 8; ///< at which importance is evaluated: one register

    /// Logarithms of importance at so many distances, up to a constant.
    using LogImportance = void (*)(const CandidateDraw& draw, const float* distances, float* logs);
    /// The function that evaluates a shape of importance, in SIMD registers or one by one (`scalar`).
    static LogImportance logImportance(Shape shape, bool grey, bool scalar = false);

    /// `draw.bound` > 0.
    LogLinearDistance(const CandidateDraw& draw, LogImportance importance);

    /// u in [0, 1) -> distance in [0, bound).
    [[nodiscard]] float sample(float u) const;
    /// Per length; 0 from the bound on.
    [[nodiscard]] float pdf(float distance) const;

  private:
    [[nodiscard]] float slope(int i) const { return logs_[size_t(i) + 1] - logs_[size_t(i)]; }

    std::array<float, Nodes + 1> nodes_; ///< ascending, from 0 to the bound
    std::array<float, Nodes + 1> logs_;  ///< of importance, the highest at 0
    std::array<float, Nodes> masses_;    ///< of the intervals
    int intervals_;
    float sum_ = 0.0f;
};

} // namespace darts
