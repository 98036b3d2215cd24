#pragma once
// The inner loop of DistanceSampler: candidates, importance and choice, written once for one candidate at a time
// (float) and for a register of them (xsimd::batch).

#include "darts/CandidateImportance.h"
#include "darts/DistanceSampler.h"
#include "darts/Lanes.h"

namespace darts {

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

    [[gnu::always_inline]] explicit Proposal(const CandidateDraw& d) : draw(d), kind(d.proposals) {
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
        if (kind == Proposals::Equiangular) aimEquiangularly();
    }
    void aimEquiangularly() {
        const Ellipse<float>& e = draw.latest;
        centre = e.C * (1.0f - e.h);
        spread = std::max(e.C * std::sqrt(e.h * (2.0f - e.h)), 1e-3f * e.length());
        // atan((bound - centre) / spread) + atan(centre / spread) as one angle, without a difference.
        angleRange = std::atan2(spread * draw.bound, spread * spread - centre * (draw.bound - centre));
    }

    /// Candidates first, first + 1, ... from uniform numbers, and there the mixture's density and, in grey media, the
    /// transmittance.
    Batch sample(const Batch& u, int first, Batch& density, Batch& transmittance) const {
        using std::max;
        using std::min;
        Batch distance(0.0f);
        if (exponentials > first) {
            const Batch lanesDrop = Channels == 1 ? Batch(drop[0]) : lanes::get<Batch>(laneDrop.data() + first);
            const Batch lanesRate = Channels == 1 ? Batch(rate[0]) : lanes::get<Batch>(laneRate.data() + first);
            const Batch left = 1.0f - u * lanesDrop; // e^{-rate d}
            distance =
                Channels == 1 ? Batch(lanes::log(left) * (-1.0f / rate[0])) : Batch(-lanes::log(left) / lanesRate);
            if (Channels == 1 && exponentials == N) {
                transmittance = left;
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
        density = pdf(distance, transmittance);
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
    Batch pdf(const Batch& d, Batch& transmittance) const {
        Batch density(0.0f);
        if constexpr (Channels == 1) {
            transmittance = lanes::exp(Batch(-rate[0] * d));
            if (exponentials > 0) density = (part[0] * rate[0] / drop[0]) * transmittance;
        } else if (exponentials > 0) {
            for (int i = 0; i < Channels; ++i)
                density = density + (part[i] * rate[i] / drop[i]) * lanes::exp(Batch(-rate[i] * d));
        }
        if (exponentials == N) return density;
        if (kind == Proposals::MixedQuarter)
            return density + (second * slowRate / slowDrop) * lanes::exp(Batch(-slowRate * d));
        if (kind == Proposals::Equiangular) {
            const Batch offset = d - centre;
            return density + (second * spread / angleRange) / (spread * spread + offset * offset);
        }
        return density + second / draw.bound;
    }
};

/// N candidates and their weights importance / density; importance is relative to the largest exponent among them.
template <typename Batch, Shape G, int N, int Channels>
struct Candidates {
    static constexpr int Width = lanes::Width<Batch>, Registers = N / Width;
    alignas(64) std::array<float, size_t(N)> distance, importance, weight;
    alignas(64) std::array<float, size_t(N)> transmittance; ///< in grey media

    Candidates(const CandidateDraw& draw, const DistanceRandom& random) {
        using lanes::select;
        using std::floor;
        using std::max;
        const int row = std::min(int(random.row * float(StratifiedRows)), StratifiedRows - 1);
        const float* strata = Stratified<N>.rows[size_t(row)].data();
        const Proposal<Batch, N, Channels> proposal(draw);
        std::array<Batch, size_t(Registers)> density, reachable;
        std::array<Batch, size_t(Registers)> exponents[Channels], factors[Channels];
        Batch highest(-std::numeric_limits<float>::max());
        for (int r = 0; r < Registers; ++r) {
            Batch u = lanes::get<Batch>(strata + size_t(r) * Width) + random.rotation;
            u = u - floor(u);
            Batch through(0.0f);
            const Batch d = proposal.sample(u, r * Width, density[r], through);
            if constexpr (Channels == 1) lanes::put(transmittance.data() + r * Width, through);
            lanes::put(distance.data() + r * Width, d);
            const PlaceOf<G, Batch> at(draw, d);
            reachable[r] = at.reachable;
            for (int i = 0; i < Channels; ++i) {
                const CandidateImportance<G> channel(draw, i, Channels == 1);
                exponents[i][r] = channel.exponent(d, at, factors[i][r]);
                highest = max(highest, select(at.reachable > 0.0f, exponents[i][r], highest));
            }
        }
        const float top = lanes::most(highest);
        for (int r = 0; r < Registers; ++r) {
            Batch value(0.0f);
            for (int i = 0; i < Channels; ++i) value = value + factors[i][r] * lanes::exp(Batch(exponents[i][r] - top));
            const Batch useful = select(reachable[r] > 0.0f, reachable[r] * value, Batch(0.0f));
            lanes::put(importance.data() + r * Width, useful);
            lanes::put(weight.data() + r * Width, Batch(useful / density[r]));
        }
    }
};

/// Chooses a candidate in proportion to its weight and returns its distance; the estimate is zero when no candidate can
/// be in time.
template <typename Batch, Shape G, int N, int Channels>
float resample(const CandidateDraw& draw, const DistanceRandom& random, Vec3& transmittanceOverPdf) {
    const Candidates<Batch, G, N, Channels> candidates(draw, random);
    float sum = 0;
    const size_t chosen = lanes::choose<N>(candidates.weight.data(), random.choice, sum);
    if (!(candidates.weight[chosen] > 0.0f)) return 0.0f;
    const float d = candidates.distance[chosen];
    const float inversePdf = sum / (float(N) * candidates.importance[chosen] * draw.probability);
    const Vec3 sigmaT = draw.medium->sigmaT();
    if constexpr (Channels == 1) {
        // The register's exponential ends at e^-87.
        const float through = sigmaT.x * d < 80.0f ? candidates.transmittance[chosen] : std::exp(-sigmaT.x * d);
        transmittanceOverPdf = Vec3{1, 1, 1} * (through * inversePdf);
    } else {
        transmittanceOverPdf =
            Vec3{std::exp(-sigmaT.x * d), std::exp(-sigmaT.y * d), std::exp(-sigmaT.z * d)} * inversePdf;
    }
    return d;
}

} // namespace darts
