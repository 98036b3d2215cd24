#pragma once
// The inner loop of DistanceSampler: candidates, target and choice, written once for one candidate at a time (float)
// and for a register of them (xsimd::batch).

#include "darts/DistanceSampler.h"
#include "darts/Stratification.h"

#include <xsimd/xsimd.hpp>

#include <array>
#include <type_traits>

namespace darts {

/// A draw in the medium: where candidates may lie, where they come from, what they are for.
struct CandidateDraw {
    Ellipse<float> latest;
    float firstLeg = 0;    ///< t(S_hi)
    float gateWidth = 0;   ///< of the connections' range
    float bound = 0;       ///< candidates lie in [0, bound)
    float probability = 1; ///< of the medium event
    float floor = 0;
    Proposals proposals = Proposals::Exponential;
    bool overlap = false;
    Vec3 throughput;
    const Medium* medium = nullptr;
};

namespace lanes {

inline float select(bool condition, float a, float b) {
    return condition ? a : b;
}
inline float sum(float a) {
    return a;
}
inline float most(float a) {
    return a;
}
template <typename Batch>
float sum(const Batch& a) {
    return xsimd::hadd(a);
}
template <typename Batch>
float most(const Batch& a) {
    alignas(64) std::array<float, Batch::size> v;
    a.store_aligned(v.data());
    for (size_t half = Batch::size / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i) v[i] = std::max(v[i], v[i + half]);
    return v[0];
}
template <typename Batch>
Batch get(const float* from) {
    if constexpr (std::is_same_v<Batch, float>)
        return *from;
    else
        return Batch::load_aligned(from);
}
template <typename Batch>
void put(float* to, const Batch& value) {
    if constexpr (std::is_same_v<Batch, float>)
        *to = value;
    else
        value.store_aligned(to);
}

template <typename Batch>
inline constexpr int Width = std::is_same_v<Batch, float> ? 1 : int(sizeof(Batch) / sizeof(float));

/// 0, 1, 2, ...
struct Numbers {
    alignas(64) std::array<float, MostCandidates> values{};
    constexpr Numbers() {
        for (int i = 0; i < MostCandidates; ++i) values[size_t(i)] = float(i);
    }
};
inline constexpr Numbers Count{};

} // namespace lanes

inline float channel(const Vec3& v, int i) {
    return i == 0 ? v.x : i == 1 ? v.y : v.z;
}

/// The target in one channel as a product of an exponential, whose exponent is kept apart, and a moderate factor; up to
/// a constant that all candidates share in grey media.
template <Greens G>
struct Target {
    float sigmaS, sigmaT, reducedS, fourthInverseD, constant = 0, inverseLength;

    Target(const CandidateDraw& draw, int index, bool grey) {
        const Medium& medium = *draw.medium;
        const float sigmaA = channel(medium.sigmaA, index), length = draw.latest.length();
        sigmaS = channel(medium.sigmaS, index);
        sigmaT = sigmaA + sigmaS;
        reducedS = std::max(sigmaS * (1.0f - medium.g), 1e-20f);
        fourthInverseD = 0.75f * (sigmaA + reducedS); // 1 / (4 D)
        inverseLength = 1.0f / length;
        if (grey) return;
        constant = std::log(std::max(channel(draw.throughput, index) * sigmaS, 1e-30f));
        if (G == Greens::Diffusion) constant += 1.5f * std::log(fourthInverseD) - sigmaA * length;
        if (G == Greens::Causal) constant += std::log(reducedS) - (reducedS + sigmaA) * length;
    }

    /// At distance d, with s = S - d left, rho from the target, and 1 - rho^2 / s^2 = causal > 0.
    template <typename Batch>
    Batch exponent(const Batch& d, const Batch& s, const Batch& rho, const Batch& causal, Batch& factor) const {
        using std::sqrt;
        if constexpr (G == Greens::None) {
            factor = Batch(1.0f);
            return constant - sigmaT * d;
        }
        const Batch part = s * inverseLength;
        if constexpr (G == Greens::Diffusion) {
            factor = 1.0f / (part * sqrt(part));
            return constant - sigmaS * d - rho * rho * fourthInverseD / s;
        }
        const Batch root = sqrt(causal), x = reducedS * s * root * sqrt(root);
        factor = sqrt((x + 2.026f) / root) / (part * part);
        return constant + x - (sigmaS - reducedS) * d;
    }
};

/// Where candidates come from: a deterministic mixture, the first ones exponential of the medium's rates, the others of
/// a second density; and the mixture's density.
template <typename Batch, int N, int Channels>
struct Proposal {
    /// Below this optical depth the truncated exponential is drawn as a uniform density, which it nearly is.
    static constexpr float Shallow = 0.05f;

    const CandidateDraw& draw;
    int exponentials = N;                                      ///< candidates [0, exponentials) are exponential
    float rate[Channels], part[Channels] = {}, drop[Channels]; ///< drop = 1 - e^{-rate bound}
    alignas(64) std::array<float, N> laneRate, laneDrop;
    float second = 0; ///< share of the second density
    float slowRate = 0, slowDrop = 0;
    float centre = 0, spread = 1, angleRange = 0;
    Proposals kind;

    explicit Proposal(const CandidateDraw& d) : draw(d), kind(d.proposals) {
        const Vec3 sigmaT = draw.medium->sigmaT();
        const float highest = largest(sigmaT);
        if (highest * draw.bound < Shallow && kind != Proposals::Equiangular) {
            kind = Proposals::MixedUniform;
            exponentials = 0;
        } else if (kind == Proposals::Equiangular) {
            exponentials = 0;
        } else if (N > 1 && kind != Proposals::Exponential && draw.bound < std::numeric_limits<float>::infinity()) {
            exponentials = N / 2;
        }
        second = float(N - exponentials) / float(N);
        for (int i = 0; i < Channels; ++i) {
            // A single candidate cannot be shared among the channels' rates.
            rate[i] = Channels == 1 ? highest : N == 1 ? mean(sigmaT) : std::max(channel(sigmaT, i), 0.05f * highest);
            drop[i] = 1.0f - std::exp(-rate[i] * draw.bound);
        }
        if constexpr (Channels == 1) part[0] = 1.0f - second;
        if constexpr (Channels > 1)
            for (int lane = 0; lane < N; ++lane) {
                laneRate[lane] = rate[lane % Channels];
                laneDrop[lane] = drop[lane % Channels];
                if (lane < exponentials) part[lane % Channels] += 1.0f / float(N);
            }
        if (kind == Proposals::MixedQuarter) {
            slowRate = 0.25f * mean(sigmaT);
            slowDrop = -std::expm1(-slowRate * draw.bound);
        }
        if (kind == Proposals::Equiangular) aimAtTarget();
    }
    void aimAtTarget() {
        const Ellipse<float>& e = draw.latest;
        centre = e.C * (1.0f - e.h);
        spread = std::max(e.C * std::sqrt(e.h * (2.0f - e.h)), 1e-3f * e.length());
        // atan((bound - centre) / spread) + atan(centre / spread) as one angle, without a difference.
        angleRange = std::atan2(spread * draw.bound, spread * spread - centre * (draw.bound - centre));
    }

    /// Candidates first, first + 1, ... from uniform numbers, and the mixture's density there.
    Batch sample(const Batch& u, int first, Batch& density) const {
        using std::log;
        using std::max;
        using std::min;
        Batch distance(0.0f);
        if (exponentials > first) {
            const Batch lanesDrop = Channels == 1 ? Batch(drop[0]) : lanes::get<Batch>(laneDrop.data() + first);
            const Batch lanesRate = Channels == 1 ? Batch(rate[0]) : lanes::get<Batch>(laneRate.data() + first);
            const Batch left = 1.0f - u * lanesDrop; // e^{-rate d}
            distance = -log(left) / lanesRate;
            if (Channels == 1 && exponentials == N) {
                density = left * (rate[0] / drop[0]);
                return min(distance, Batch(draw.bound));
            }
        }
        if (exponentials < first + lanes::Width<Batch>) {
            const auto isExponential = lanes::get<Batch>(lanes::Count.values.data() + first) < float(exponentials);
            using lanes::select;
            distance = select(isExponential, distance, sampleSecond(u));
        }
        distance = max(min(distance, Batch(draw.bound)), Batch(0.0f));
        density = pdf(distance);
        return distance;
    }
    Batch sampleSecond(const Batch& u) const {
        using std::log1p;
        using std::tan;
        if (kind == Proposals::MixedQuarter) return -log1p(-u * slowDrop) / slowRate;
        if (kind == Proposals::Equiangular) { // tan of a sum, multiplied out
            const Batch turned = tan(u * angleRange);
            return (spread * spread + centre * centre) * turned / (spread + centre * turned);
        }
        return u * draw.bound;
    }
    Batch pdf(const Batch& d) const {
        using std::exp;
        Batch density(0.0f);
        if (exponentials > 0)
            for (int i = 0; i < Channels; ++i) density = density + (part[i] * rate[i] / drop[i]) * exp(-rate[i] * d);
        if (exponentials == N) return density;
        if (kind == Proposals::MixedQuarter) return density + (second * slowRate / slowDrop) * exp(-slowRate * d);
        if (kind == Proposals::Equiangular) {
            const Batch offset = d - centre;
            return density + (second * spread / angleRange) / (spread * spread + offset * offset);
        }
        return density + second / draw.bound;
    }
};

/// N candidates and their weights target / density; the target is relative to the largest exponent among them.
template <typename Batch, Greens G, int N, int Channels>
struct Candidates {
    static constexpr int Registers = N / lanes::Width<Batch>;
    std::array<Batch, size_t(Registers)> distance, target, weight;
    float sum = 0; ///< of the weights

    Candidates(const CandidateDraw& draw, const DistanceRandom& random) {
        using lanes::select;
        using std::exp;
        const size_t row = std::min(size_t(random.row * float(StratifiedRows)), size_t(StratifiedRows - 1));
        const float* strata = Stratified<N>.rows[row].data();
        const Proposal<Batch, N, Channels> proposal(draw);
        std::array<Batch, size_t(Registers)> density, reach;
        std::array<Batch, size_t(Registers)> exponents[Channels], factors[Channels];
        Batch highest(-std::numeric_limits<float>::max());
        for (int r = 0; r < Registers; ++r) {
            using std::floor;
            Batch u = lanes::get<Batch>(strata + r * lanes::Width<Batch>) + random.rotation;
            u = u - floor(u);
            distance[r] = proposal.sample(u, r * lanes::Width<Batch>, density[r]);
            Batch s, rho, causal;
            reach[r] = geometry(draw, distance[r], s, rho, causal);
            for (int i = 0; i < Channels; ++i) {
                using std::max;
                const Target<G> target_(draw, i, Channels == 1);
                exponents[i][r] = target_.exponent(distance[r], s, rho, causal, factors[i][r]);
                highest = max(highest, select(reach[r] > 0.0f, exponents[i][r], highest));
            }
        }
        const float top = lanes::most(highest);
        Batch total(0.0f);
        for (int r = 0; r < Registers; ++r) {
            Batch value(0.0f);
            for (int i = 0; i < Channels; ++i) value = value + factors[i][r] * exp(exponents[i][r] - top);
            target[r] = select(reach[r] > 0.0f, reach[r] * value, Batch(0.0f));
            total = total + target[r];
        }
        if (draw.floor > 0) {
            const float lift = draw.floor * lanes::sum(total) / float(N);
            for (int r = 0; r < Registers; ++r) target[r] = select(reach[r] > 0.0f, target[r] + lift, Batch(0.0f));
        }
        total = Batch(0.0f);
        for (int r = 0; r < Registers; ++r) {
            weight[r] = target[r] / density[r];
            total = total + weight[r];
        }
        sum = lanes::sum(total);
    }
    /// The part of the gate still reachable (1 without overlap), 0 where nothing can be in time.
    static Batch geometry(const CandidateDraw& draw, const Batch& d, Batch& s, Batch& rho, Batch& causal) {
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
        const Batch reachable = draw.overlap ? Batch(min(left / (s + rho), Batch(draw.gateWidth))) : Batch(1.0f);
        causal = select(inTime, left / (s * s), Batch(1.0f));
        return select(inTime, reachable, Batch(0.0f));
    }
};

/// Chooses a candidate in proportion to its weight and returns its distance; the estimate is zero when no candidate can
/// be in time.
template <typename Batch, Greens G, int N, int Channels>
float resample(const CandidateDraw& draw, const DistanceRandom& random, Vec3& transmittanceOverPdf) {
    const Candidates<Batch, G, N, Channels> candidates(draw, random);
    if (!(candidates.sum > 0.0f)) return 0.0f;
    alignas(64) std::array<float, N> distance, target, weight;
    for (int r = 0; r < candidates.Registers; ++r) {
        lanes::put(distance.data() + r * lanes::Width<Batch>, candidates.distance[r]);
        lanes::put(target.data() + r * lanes::Width<Batch>, candidates.target[r]);
        lanes::put(weight.data() + r * lanes::Width<Batch>, candidates.weight[r]);
    }
    float rest = random.choice * candidates.sum;
    size_t chosen = 0;
    for (; chosen < N - 1; ++chosen) {
        rest -= weight[chosen];
        if (rest < 0.0f) break;
    }
    while (chosen > 0 && !(weight[chosen] > 0.0f)) --chosen; // rounding at the end
    if (!(weight[chosen] > 0.0f)) return 0.0f;
    const float d = distance[chosen], inversePdf = candidates.sum / (float(N) * target[chosen] * draw.probability);
    const Vec3 sigmaT = draw.medium->sigmaT();
    const float x = std::exp(-sigmaT.x * d) * inversePdf;
    transmittanceOverPdf = {x, x, x};
    if constexpr (Channels > 1) {
        transmittanceOverPdf.y = std::exp(-sigmaT.y * d) * inversePdf;
        transmittanceOverPdf.z = std::exp(-sigmaT.z * d) * inversePdf;
    }
    return d;
}

namespace detail {

template <int N>
struct Register {
    using type = std::conditional_t<(N < int(xsimd::batch<float>::size)), xsimd::make_sized_batch_t<float, size_t(N)>,
                                    xsimd::batch<float>>;
};
template <>
struct Register<1> {
    using type = float;
};

} // namespace detail

/// The widest register of the machine compiled for that N candidates fill.
template <int N>
using RegisterOf = typename detail::Register<N>::type;

} // namespace darts
