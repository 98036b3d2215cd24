#pragma once
// Distances to the next vertex, resampled towards the light that can still arrive inside the gate.

#include "darts/CandidateImportance.h"
#include "darts/Settings.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

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

    struct Draw {
        float distance; ///< in [0, bound)
        float pdf;      ///< there
    };
    /// u in [0, 1)
    [[nodiscard]] Draw sample(float u) const;
    /// Per length; 0 from the bound on.
    [[nodiscard]] float pdf(float distance) const;
    /// Importance of the surface at the bound over that of all draws: of light that goes on from there, beside what
    /// scatters before by `sigmaS` a length.
    [[nodiscard]] float partOfEnd(float sigmaS) const {
        const float end = std::exp(logs_[size_t(intervals_)]);
        return end / (end + sigmaS * sum_);
    }

  private:
    [[nodiscard]] float slope(int i) const { return logs_[size_t(i) + 1] - logs_[size_t(i)]; }

    alignas(64) std::array<float, Nodes + 1> nodes_; ///< ascending, from 0 to the bound
    alignas(64) std::array<float, Nodes + 1> logs_;  ///< of importance, the highest at 0
    alignas(64) std::array<float, Nodes> masses_;    ///< of the intervals
    int intervals_;
    float sum_ = 0.0f;
};

/// Uniform numbers in [0, 1) of one draw.
struct DistanceRandom {
    float row, rotation, choice, event;
};

/// A distance along the ray, or the surface at its end.
struct DistanceSample {
    float distance = 0;
    bool surface = false;
    /// Per channel: transmittance over the density of this draw (per length in the medium, a probability at the
    /// surface), whose expectation over the draws is the integral of the transmittance over what can count. In the
    /// medium the caller's throughput takes sigmaS times this. Zero: nothing can arrive, the walk ends.
    Vec3 transmittanceOverPdf;
    /// Density of this draw: per length in the medium, a probability at the surface. 0 where the distance is resampled,
    /// whose density is not known.
    float pdf = 0;
};

/// How distances are distributed from a place along a ray, where they are drawn by a density that is known.
class DistanceDensity {
  public:
    /// Nothing in the medium: every draw is the surface, if `surface` is a probability above 0.
    explicit DistanceDensity(float surface) : surface_(surface) {}
    DistanceDensity(float surface, const CandidateDraw& draw, LogLinearDistance::LogImportance importance)
        : surface_(surface), medium_(std::in_place, draw, importance) {}

    /// Probability of the surface; the rest is the medium's, unless nothing there can be in time.
    [[nodiscard]] float surface() const { return surface_; }
    /// All but a tenth of the flights choose between surface and medium by the importance of either, so that neither is
    /// drawn more than ten times less often than by free flights. (Variance of guided paths with a half, nine tenths
    /// and all, over that of free flights whose odds of surfaces in view are measured: scattering 0.3 0.93, 0.85, 0.85,
    /// scattering 1.0 0.85, 0.76, 0.75, two rooms 0.99, 0.86, 0.86. Bench: study scattering and bodies, paths.)
    void weighSurface(float sigmaS) {
        constexpr float Natural = 0.1f;
        if (medium_ && surface_ > 0.0f) surface_ = Natural * surface_ + (1.0f - Natural) * medium_->partOfEnd(sigmaS);
    }
    /// Per length.
    [[nodiscard]] float pdf(float distance) const {
        return medium_ ? (1.0f - surface_) * medium_->pdf(distance) : 0.0f;
    }
    /// In the medium, with the density there.
    [[nodiscard]] std::optional<LogLinearDistance::Draw> sample(float u) const {
        if (!medium_) return std::nullopt;
        const auto [distance, pdf] = medium_->sample(u);
        return LogLinearDistance::Draw{distance, (1.0f - surface_) * pdf};
    }

  private:
    float surface_;
    std::optional<LogLinearDistance> medium_;
};

/// Resampled importance sampling (Talbot et al. 2005) of N candidates by importance
///   p(d) = e^{-sigmaT d} Phi(|x + d w - q|, S_hi - d) o(d),
/// Phi a Green's function, or the first passage out of the body (FirstPassage.h) where the target lies outside, o(d)
/// the length of the gate still reachable. All causality is tested at S_hi, which does not change from vertex to
/// vertex: a length redrawn per vertex would be biased. Any positive importance is exact. The transmittances that
/// the estimate needs are computed to float precision, importance to about 1e-3.
class DistanceSampler {
  public:
    /// Candidates in SIMD registers; `scalar` takes one by one (for comparison).
    DistanceSampler(const Settings& settings, const Medium& medium, bool scalar = false);

    /// `surface` is the distance to the first surface, possibly infinite; `throughput` the walk's, for coloured media.
    [[nodiscard]] DistanceSample sample(const TimeBudget& budget, const Heading& ray, float surface,
                                        const Vec3& throughput, const DistanceRandom& random) const;
    /// The density of sample(), of Preset::Best.
    [[nodiscard]] DistanceDensity density(const TimeBudget& budget, const Heading& ray, float surface,
                                          const Vec3& throughput) const;
    /// A draw by it; `event` and `choice` are uniform in [0, 1).
    [[nodiscard]] DistanceSample sample(const DistanceDensity& density, float surface, float event, float choice) const;
    /// Where the candidates end: nothing beyond can be in time. The ray need not be traced farther.
    [[nodiscard]] float bound(const TimeBudget& budget, float h) const {
        return settings_.bounded ? budget.latest(h).firstLeg() : std::numeric_limits<float>::infinity();
    }

    /// e^{-sigmaT d} per channel.
    [[nodiscard]] Vec3 transmittance(float distance) const;

  private:
    /// The event at the surface as free flights have it: its probability, and that of getting there by channel.
    struct SurfaceEvent {
        float probability = 0;
        Vec3 reaching;
    };
    [[nodiscard]] SurfaceEvent surfaceEvent(float surface, float firstLeg, const Vec3& throughput) const;
    /// What a draw of distances in the medium needs, up to a bound above 0.
    [[nodiscard]] CandidateDraw drawOf(const TimeBudget& budget, const Heading& ray, const Ellipse<float>& latest,
                                       float bound, const Vec3& throughput) const;
    [[nodiscard]] Shape shapeFor(const TimeBudget& budget) const;
    using Kernel = float (*)(const CandidateDraw&, const DistanceRandom&, Vec3& transmittanceOverPdf);

    Settings settings_;
    Medium medium_;
    Vec3 sigmaT_;
    float meanSigmaT_;
    bool grey_, scatters_;
    // One for each Shape.
    std::array<Kernel, 4> kernels_;
    std::array<LogLinearDistance::LogImportance, 4> importance_;
};

} // namespace darts
