#pragma once
// What DistanceSampler's candidates are weighed by: the light that can still arrive from there. Written once for one
// candidate at a time (float) and for a register of them (xsimd::batch).

#include "darts/FirstPassage.h"
#include "darts/Lanes.h"
#include "darts/Settings.h"
#include "darts/TimeBudget.h"

namespace darts {

/// What shapes the importance of candidates: nothing but the bound in time, a Green's function of an infinite medium,
/// or the way out of a body.
enum class Shape { TimeBound, Diffusion, Causal, FirstPassage };

/// A draw in the medium: where candidates may lie, where they come from, what they are for.
struct CandidateDraw {
    Ellipse<float> latest;
    float firstLeg = 0;    ///< t(S_hi)
    float gateWidth = 0;   ///< of the connections' range
    float bound = 0;       ///< candidates lie in [0, bound)
    float kink = 0;        ///< where the reachable part of the gate begins to shrink; 0: everywhere
    bool falls = true;     ///< importance falls to nothing towards the bound in time
    float probability = 1; ///< of the medium event
    Proposals proposals = Proposals::Exponential;
    bool overlap = false;
    float power = 1; ///< of importance over a free flight's, where the density is known
    Vec3 throughput;
    const Medium* medium = nullptr;
    const EscapeGeometry* escape = nullptr; ///< of Shape::FirstPassage
    Vec3 direction;                         ///< of the ray, for it
};

inline float channel(const Vec3& v, int i) {
    return i == 0 ? v.x : i == 1 ? v.y : v.z;
}

/// A candidate's place: path length s left at the latest arrival, rho to the target, 1 - rho^2 / s^2, and the part of
/// the gate still reachable (1 without overlap; 0 where nothing can be in time).
template <typename Batch>
struct CandidatePlace {
    Batch s, inverseS, rho, causal, reachable;

    CandidatePlace() = default;
    [[gnu::always_inline]] CandidatePlace(const CandidateDraw& draw, const Batch& d) {
        using lanes::select;
        using std::min;
        using std::sqrt;
        const Ellipse<float>& e = draw.latest;
        const Batch toCentre = d - e.C;
        rho = sqrt(toCentre * toCentre + (2.0f * e.C * e.h) * d);
        // 2 A (t_M - d) = (s - rho)(s + rho): what is left of the excess, without a difference of lengths.
        const Batch left = (2.0f * e.denominator()) * (draw.firstLeg - d);
        const auto inTime = left > 0.0f;
        s = select(inTime, e.length() - d, Batch(e.length()));
        inverseS = 1.0f / s;
        const Batch overlap = draw.overlap ? Batch(min(left / (s + rho), Batch(draw.gateWidth))) : Batch(1.0f);
        causal = select(inTime, left * inverseS * inverseS, Batch(1.0f));
        reachable = select(inTime, overlap, Batch(0.0f));
    }
};

/// A candidate's place in a bounded medium that light must leave.
template <typename Batch>
struct EscapeCandidate {
    EscapePoint<Batch> departure;
    Batch reachable; ///< 1; 0 where nothing can be in time

    [[gnu::always_inline]] EscapeCandidate(const CandidateDraw& draw, const Batch& d)
        : departure(*draw.escape, draw.latest, draw.direction, d, draw.medium->persistenceLength()),
          reachable(oneBefore(d, draw.firstLeg)) {}

  private:
    static Batch oneBefore(const Batch& d, float end) {
        using lanes::select;
        return select(d < end, Batch(1.0f), Batch(0.0f));
    }
};

/// CandidateImportance in one channel, as a product of an exponential, whose exponent is kept apart, and a moderate
/// factor; up to a constant that all candidates share in grey media.
template <Shape G>
struct CandidateImportance {
    float sigmaS, sigmaT, reducedS, fourthInverseD, constant = 0, length;

    CandidateImportance(const CandidateDraw& draw, int index, bool grey) {
        const Medium& medium = *draw.medium;
        const float sigmaA = channel(medium.sigmaA, index);
        length = draw.latest.length();
        sigmaS = channel(medium.sigmaS, index);
        sigmaT = sigmaA + sigmaS;
        reducedS = std::max(sigmaS * (1.0f - medium.g), 1e-20f);
        fourthInverseD = 0.75f * (sigmaA + reducedS); // 1 / (4 D)
        if (grey) return;
        constant = std::log(std::max(channel(draw.throughput, index) * sigmaS, 1e-30f));
        if (G == Shape::Diffusion) constant += 1.5f * std::log(fourthInverseD) - sigmaA * length;
        if (G == Shape::Causal) constant += std::log(reducedS) - (reducedS + sigmaA) * length;
    }

    /// At distance d, with s = S - d left, rho from the target, and 1 - rho^2 / s^2 = causal > 0.
    template <typename Batch>
    Batch exponent(const Batch& d, const CandidatePlace<Batch>& at, Batch& factor) const {
        using std::sqrt;
        if constexpr (G == Shape::TimeBound) {
            factor = Batch(1.0f);
            return constant - sigmaT * d;
        }
        const Batch part = at.inverseS * length; // S / s
        if constexpr (G == Shape::Diffusion) {
            factor = part * sqrt(part);
            return constant - sigmaS * d - at.rho * at.rho * fourthInverseD * at.inverseS;
        }
        const Batch root = sqrt(at.causal), x = reducedS * at.s * root * sqrt(root);
        factor = sqrt((x + 2.026f) / root) * (part * part);
        return constant + x - (sigmaS - reducedS) * d;
    }
};

/// Importance where light must leave a bounded medium (FirstPassage.h).
template <>
struct CandidateImportance<Shape::FirstPassage> {
    FirstPassage passage;
    float sigmaT, constant = 0;

    CandidateImportance(const CandidateDraw& draw, int index, bool grey)
        : passage(channel(draw.medium->sigmaA, index),
                  std::max(channel(draw.medium->sigmaS, index) * (1.0f - draw.medium->g), 1e-20f), *draw.escape),
          sigmaT(channel(draw.medium->sigmaT(), index)) {
        if (!grey)
            constant =
                std::log(std::max(channel(draw.throughput, index) * channel(draw.medium->sigmaS, index), 1e-30f));
    }

    template <typename Batch>
    Batch exponent(const Batch& d, const EscapeCandidate<Batch>& at, Batch& factor) const {
        return constant - sigmaT * d + passage.exponent(at.departure, factor);
    }
};

/// Where candidates of a shape are.
template <Shape G, typename Batch>
using PlaceOf = std::conditional_t<G == Shape::FirstPassage, EscapeCandidate<Batch>, CandidatePlace<Batch>>;

} // namespace darts
