#pragma once
// Runs variants on cases for a given processor time.

#include "Report.h"

namespace infinite_medium {

struct Budget {
    double seconds = 1; ///< processor time per variant and case, gathering photons included
    uint64_t paths = 0; ///< per variant and case; 0: as many as there is time for
    uint64_t seed = 1;
    unsigned threads = 1;
    int batches = 40;
    double nsPerRay = 200; ///< added to the cost of a photon path for every ray that a scene would have it trace
};

/// All variants on all cases, in path mode: one experiment.
Experiment measurePaths(std::vector<Case> cases, std::vector<Variant> variants, const Budget& budget);
/// In photon mode: the cone and the sphere, images of the same photons.
std::vector<Experiment> measurePhotons(std::vector<Case> cases, std::vector<Variant> variants, const Budget& budget);

} // namespace infinite_medium
