#pragma once
// Weights of a path that several techniques find (multiple importance sampling; Veach and Guibas 1995): over all of
// them they add up to one.

#include <cmath>

namespace tungsten::transport {

/// Balance heuristic: the part left to the technique that finds the path with density `own`, beside others that find it
/// with densities in the same measure. 0 where the technique does not find it.
template <typename... Densities>
[[nodiscard]] float balance(float own, Densities... others) {
    return own > 0.0f ? own / (own + ... + others) : 0.0f;
}

/// The same, more in favour of the higher of two densities (exponent 2).
[[nodiscard]] inline float powerHeuristic(float own, float other) {
    const float squared = own * own, others = other * other;
    return squared + others > 0.0f ? squared / (squared + others) : 0.0f;
}

/// Density per length of free flights that end at `distance`, for weights: one rate for all channels.
[[nodiscard]] inline float pdfFreeFlight(float sigmaT, float distance) {
    return sigmaT * std::exp(-sigmaT * distance);
}

} // namespace tungsten::transport
