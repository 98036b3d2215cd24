#pragma once
// Distances to the next vertex, resampled towards the light that can still arrive inside the gate.

#include "darts/ResidualRange.h"
#include "darts/Settings.h"

namespace darts {

struct CandidateDraw;

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
};

/// Resampled importance sampling (Talbot et al. 2005) of N candidates by usefulness
///   p(d) = e^{-sigmaT d} Phi(|x + d w - q|, S_hi - d) o(d),
/// Phi a Green's function, or the first passage out of the body (FirstPassage.h) where the target lies outside, o(d)
/// the length of the gate still reachable. All causality is tested at S_hi, which does not change from vertex to
/// vertex: a length redrawn per vertex would be biased. Any positive usefulness is exact. The transmittances that
/// the estimate needs are computed to float precision, usefulness to about 1e-3.
class DistanceSampler {
  public:
    /// Candidates in SIMD registers; `scalar` takes one by one (for comparison).
    DistanceSampler(const Settings& settings, const Medium& medium, bool scalar = false);

    /// `surface` is the distance to the first surface, possibly infinite; `throughput` the walk's, for coloured media.
    [[nodiscard]] DistanceSample sample(const Residual& residual, const Heading& ray, float surface,
                                        const Vec3& throughput, const DistanceRandom& random) const;
    /// Where the candidates end: nothing beyond can be in time. The ray need not be traced farther.
    [[nodiscard]] float bound(const Residual& residual, float h) const {
        return settings_.bounded ? residual.latest(h).firstLeg() : std::numeric_limits<float>::infinity();
    }

    /// e^{-sigmaT d} per channel.
    [[nodiscard]] Vec3 transmittance(float distance) const;

  private:
    using Kernel = float (*)(const CandidateDraw&, const DistanceRandom&, Vec3& transmittanceOverPdf);
    /// By how light gets to the target.
    struct Kernels {
        Kernel through = nullptr, out = nullptr, refracted = nullptr, unknown = nullptr;
    };
    /// Of usefulness, relative to the candidates' mean. Diffusion knows little of the last few scatterings in a body:
    /// what it calls useless still shows, too bright for its odds. Over a long way a constant floor would lead every
    /// walk astray; this one leads `strays` flights of each.
    [[nodiscard]] float floor(const Residual& residual) const;
    static constexpr float MostFloor = 0.05f;
    static Kernels chooseKernels(const Settings& settings, bool grey, bool scalar);

    Settings settings_;
    Medium medium_;
    Vec3 sigmaT_;
    float meanSigmaT_;
    bool grey_, scatters_;
    Kernels kernels_;
};

} // namespace darts
