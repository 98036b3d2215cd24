#pragma once
// Russian roulette of plain walks.

#include "tungsten/core/Random.h"

namespace tungsten::transport {

/// False ends the path; else the throughput, relative to that of the path's start, makes up for those that ended.
inline bool survivesRoulette(Rgb& throughput, int interactions, Sampler& sampler) {
    constexpr float Threshold = 0.1f;
    constexpr int FirstInteraction = 3;
    if (interactions < FirstInteraction) return true;
    const float survival = maxComponent(throughput);
    if (survival >= Threshold) return true;
    if (sampler.next1D() >= survival) return false;
    throughput = throughput / survival;
    return true;
}

} // namespace tungsten::transport
