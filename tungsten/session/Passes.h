#pragma once
// Passes: how much of a render each takes, which of them processes render at once, and what they have met by then.

#include "tungsten/integrator/Integrator.h"
#include "tungsten/session/DistributedFilm.h"
#include "tungsten/session/SessionResult.h"

#include <cstdint>
#include <string>

namespace tungsten {

struct PassSize {
    uint32_t samples = 1; ///< per pixel
    double share = 1.0;   ///< of the light paths of a whole pass
    double weight = 1.0;  ///< samples per pixel of the render that are done by it
};

/// Passes of `step` samples per pixel, and smaller ones where even the first does not end in time. Where light paths
/// can be cut, so many cut passes trace as many light paths as the whole ones that they are made of.
class PassSizes {
  public:
    PassSizes(uint64_t samples, uint64_t step, bool cutsLightPaths)
        : samples_(double(samples)), step_(step), cutsLightPaths_(cutsLightPaths) {}

    /// False: passes are as small as they get.
    [[nodiscard]] bool canCut() const;
    /// Makes all passes from now on smaller, if they can be: a quarter of what was done of one, `fraction`, or about.
    void cut(double fraction);
    [[nodiscard]] double share() const { return 1.0 / parts_; }
    /// "passes are cut to 1 sample per pixel".
    [[nodiscard]] std::string text() const;
    /// Of the next pass after passes of this weight in all.
    [[nodiscard]] PassSize next(double done) const;
    /// Everything that is left after passes of this weight in all, as one pass.
    [[nodiscard]] PassSize rest(double done) const;
    /// Passes that are left after passes of this weight in all.
    [[nodiscard]] uint32_t left(double done) const;

  private:
    [[nodiscard]] uint32_t samplesOfPass() const;

    double samples_; ///< of the render
    uint64_t step_;
    bool cutsLightPaths_;
    double parts_ = 1.0; ///< of a whole pass
};

/// A pass of a session.
struct PlannedPass {
    PassSize size;
    uint32_t index = 0; ///< in the session, whose first pass may be a later one of the render
    double done = 0.0;  ///< weight of those before it

    /// `firstPass`: of the session.
    [[nodiscard]] PassInfo info(uint32_t firstPass, uint64_t sppStep, uint64_t seed) const;
};

/// From `first` on, one for each rank, as far as there are samples left.
std::vector<PlannedPass> roundOf(const PassSizes& sizes, PlannedPass first, size_t ranks, double samples);

/// Samples per pixel of a session. Throws UsageError for passes that the render does not have.
uint64_t samplesOf(const SessionOptions& options);

struct RoundStatus {
    bool interrupted = false, timedOut = false;
    bool wantsFilm = false; ///< for a checkpoint, the trace or the progress bar
    bool whole = true;      ///< this rank's pass, or it had none
    double brokenAt = 0.0;  ///< part of the pass that had been rendered where it is not whole; of all ranks, the least
    size_t wholePasses = 0; ///< of the round, before the first that was broken off: set by among()

    /// Asks all ranks, each of which has its own. Must be called by all of them. `ranks`: how many there are.
    [[nodiscard]] RoundStatus among(DistributedResult& shared, size_t ranks) const;
};

} // namespace tungsten
