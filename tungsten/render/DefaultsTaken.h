#pragma once
// Counts, radii and bounces that a scene leaves open, and what they are then.

#include "tungsten/render/Job.h"

namespace tungsten {

/// A number that the blocks `integrator` or `renderer` could have given.
struct DefaultTaken {
    std::string field;   ///< "integrator.photon_count"
    std::string value;   ///< as `--describe` has it, or what was made for this scene with the reason
    std::string meaning; ///< as `--describe` has it
};

/// Of numbers that are no times, speeds or stops (the plan's first line tells when the sensor is open), and whose
/// default is not 0, which does nothing.
std::vector<DefaultTaken> defaultsTaken(const Job& job, const IntegratorRegistry& registry);

} // namespace tungsten
