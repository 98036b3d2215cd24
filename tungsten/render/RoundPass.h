#pragma once
// The passes that ranks render at once.

#include "tungsten/render/Integrator.h"
#include "tungsten/render/PassSizes.h"
#include "tungsten/render/RenderSession.h"

namespace tungsten {

/// A pass of a session.
struct RoundPass {
    PassSize size;
    uint32_t index = 0; ///< in the session, whose first pass may be a later one of the render
    double done = 0.0;  ///< weight of those before it

    /// `firstPass`: of the session.
    [[nodiscard]] PassInfo info(uint32_t firstPass, uint64_t sppStep, uint64_t seed) const;
};

/// From `first` on, one for each rank, as far as there are samples left.
std::vector<RoundPass> roundOf(const PassSizes& sizes, RoundPass first, size_t ranks, double samples);

/// Samples per pixel of a session. Throws UsageError for passes that the render does not have.
uint64_t samplesOf(const SessionOptions& options);

} // namespace tungsten
