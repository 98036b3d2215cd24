#pragma once
// Weights of a path that several techniques find (multiple importance sampling; Veach and Guibas 1995): over all of
// them they add up to one.

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

} // namespace tungsten::transport
