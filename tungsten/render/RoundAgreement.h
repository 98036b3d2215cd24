#pragma once
// What the ranks of a team have met by the end of a round of passes: whatever any of them has, counts for all, so that
// all go on or stop together.

#include "tungsten/render/SharedResult.h"

namespace tungsten {

struct RoundAgreement {
    bool interrupted = false, timedOut = false;
    bool wantsFilm = false; ///< for a checkpoint, the trace or the progress bar
    bool whole = true;      ///< this rank's pass, or it had none
    double brokenAt = 0.0;  ///< part of the pass that had been rendered where it is not whole; of all ranks, the least
    size_t wholePasses = 0; ///< of the round, before the first that was broken off: set by among()

    /// Asks all ranks, each of which has its own. Must be called by all of them. `ranks`: how many there are.
    [[nodiscard]] RoundAgreement among(SharedResult& shared, size_t ranks) const;
};

} // namespace tungsten
