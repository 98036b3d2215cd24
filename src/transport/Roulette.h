#pragma once
// Russian roulette of plain walks.

#include "transport/Tuning.h"

#include "tungsten/core/Random.h"

namespace tungsten::transport {

/// False ends the path; else the throughput, relative to that of the path's start, makes up for those that ended.
inline bool survivesRoulette(Rgb& throughput, int interactions, Sampler& sampler) {
    if (interactions < tuning::RouletteFirstInteraction) return true;
    const float survival = maxComponent(throughput);
    if (survival >= tuning::RouletteThreshold) return true;
    if (sampler.next1D() >= survival) return false;
    throughput = throughput / survival;
    return true;
}

} // namespace tungsten::transport
