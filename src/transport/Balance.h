#pragma once
// Weights of a path that several techniques find (multiple importance sampling; Veach and Guibas 1995): over all of
// them they add up to one. Plain and guided walks side by side are weighed by how densely both together find what one
// has found (docs/method.md, section 11).

#include <algorithm>
#include <cmath>
#include <limits>

namespace tungsten::transport {

/// Balance heuristic: the part left to the technique that finds the path with density `own`, beside others that find it
/// with densities in the same measure. 0 where the technique does not find it.
template <typename... Densities>
[[nodiscard]] float balance(float own, Densities... others) {
    return own > 0.0f ? own / (own + ... + others) : 0.0f;
}

/// Power heuristic: more in favour of the higher of two densities (exponent 2).
[[nodiscard]] inline float powerHeuristic(float own, float other) {
    const float squared = own * own, sum = squared + other * other;
    if (squared > 1e-30f && sum < std::numeric_limits<float>::infinity()) return squared / sum;
    // Squares that leave the range of floats, as those of small lights far away do: by the ratio.
    if (!(own > 0.0f)) return 0.0f;
    const float ratio = other / own;
    return 1.0f / (1.0f + ratio * ratio);
}

/// Density per length of free flights that end at `distance`, for weights: one rate for all channels.
[[nodiscard]] inline float pdfFreeFlight(float sigmaT, float distance) {
    return sigmaT * std::exp(-sigmaT * distance);
}

enum class Strategy { Alone, Plain, Guided };

/// Logarithm of a quotient of densities, which does not depend on the unit of both; bounded where one of two ways to
/// find a path never does.
inline float logOfQuotient(float density, float over = 1.0f) {
    constexpr float Least = 1e-30f, Most = 1e30f;
    return std::log(std::clamp(std::max(density, Least) / std::max(over, Least), Least, Most));
}

/// One of two techniques of the same paths.
struct TechniqueShare {
    float beside = 1.0f; ///< MIS weight, beside guided paths
    float alone = 1.0f;  ///< the same where all paths are plain

    /// By densities, where all paths are plain and beside guided ones (power heuristic).
    struct Densities {
        float own, other;
    };
    [[nodiscard]] static TechniqueShare of(const Densities& alone, const Densities& besideGuided) {
        return {powerHeuristic(besideGuided.own, besideGuided.other), powerHeuristic(alone.own, alone.other)};
    }
};

/// How densely guided paths find what one has found, over plain ones; logarithms.
struct LogRatio {
    float weighed;                ///< as both strategies weigh it: StrategyBalance
    float plainToEstimate;        ///< plain paths' own estimate over the one at hand
    float aloneOverBeside = 1.0f; ///< not a logarithm: of the technique's shares (TechniqueShare)

    /// Both are the same, unless an estimate is random: what light paths bring is weighed by the way up to them.
    LogRatio(float exact) : weighed(exact), plainToEstimate(exact) {} // NOLINT(google-explicit-constructor)
    LogRatio(float asWeighed, float ofPlain) : weighed(asWeighed), plainToEstimate(ofPlain) {}
    /// Where a part of the guided paths alone may find it, the logarithm of which this is.
    [[nodiscard]] LogRatio plus(float logOfPart) const {
        LogRatio part = *this;
        part.weighed += logOfPart;
        part.plainToEstimate += logOfPart;
        return part;
    }
    /// What one of two techniques has found.
    [[nodiscard]] LogRatio with(const TechniqueShare& share) const {
        LogRatio same = *this;
        same.aloneOverBeside = share.alone / share.beside;
        return same;
    }
};

/// Where a contribution was found: at a vertex that its path has gone on from, or beside the path's way, where guided
/// paths alone look.
enum class Found { OnWay, Aside };

/// Shares of the paths that are plain and guided, and weights of what they bring. A path X is found by plain paths with
/// the density lambda_P, by guided ones with lambda_G = lambda_P e^L; either adds f / (plain lambda_P + guided
/// lambda_G), which is its own estimate f / lambda times a weight. No contribution exceeds what plain paths bring, over
/// `plain`.
struct StrategyBalance {
    float plain = 0.0f, guided = 1.0f; ///< sum 1

    [[nodiscard]] bool both() const { return plain > 0.0f && guided > 0.0f; }
    /// Weight of what a plain path has found, as its own estimate alone would have it; `logRatio` is L.
    [[nodiscard]] float weightOfPlain(float logRatio) const {
        return 1.0f / (plain + guided * std::exp(std::min(logRatio, Most)));
    }
    [[nodiscard]] float weightOfGuided(float logRatio) const {
        return 1.0f / (plain * std::exp(std::min(-logRatio, Most)) + guided);
    }
    /// How densely both find what guided paths find so densely, over plain paths alone; at least 1. A technique of both
    /// shares by it with one of plain paths; neither then brings more than the one or the other where all are plain,
    /// over `plain`. Bounded, so that what its square leaves to the other is still a float.
    [[nodiscard]] float overPlain(float logRatio) const {
        constexpr float MostLog = 16.0f;
        return std::max(plain + guided * std::exp(std::min(logRatio, MostLog)), 1.0f);
    }
    [[nodiscard]] float weight(Strategy strategy, float logRatio) const {
        if (strategy == Strategy::Alone) return 1.0f;
        return strategy == Strategy::Plain ? weightOfPlain(logRatio) : weightOfGuided(logRatio);
    }
    /// Guided paths end where plain ones are so much denser, which hardly ever happens (Markov: at most e^-EarlyOut of
    /// them in each generation); plain paths that go where they do not need no densities from there on.
    [[nodiscard]] bool endsGuided(float logRatio) const { return both() && logRatio < -EarlyOut; }

    static constexpr float EarlyOut = 8.0f;
    /// L where guided paths do not come.
    static constexpr float Never = -80.0f;

  private:
    static constexpr float Most = 80.0f; ///< of exponents
};

} // namespace tungsten::transport
