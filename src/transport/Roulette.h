#pragma once
// Russian roulette of plain walks.

#include "transport/Tuning.h"

#include "tungsten/core/Random.h"

namespace tungsten::transport {

/// Probability of going on; `throughput` relative to that of the path's start.
inline float survivalByThroughput(const Rgb& throughput, int interactions) {
    const float survival = maxComponent(throughput);
    return interactions < tuning::RouletteFirstInteraction || survival >= tuning::RouletteThreshold ? 1.0f : survival;
}

/// False ends the path; else the throughput, relative to that of the path's start, makes up for those that ended.
inline bool survivesRoulette(Rgb& throughput, int interactions, Sampler& sampler) {
    const float survival = survivalByThroughput(throughput, interactions);
    if (survival == 1.0f) return true;
    if (sampler.next1D() >= survival) return false;
    throughput = throughput / survival;
    return true;
}

} // namespace tungsten::transport
