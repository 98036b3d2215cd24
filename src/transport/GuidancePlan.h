#pragma once
// What the plans of all guided walks ask in common, of camera paths and of light paths.

#include "transport/Policy.h"

#include "tungsten/integrator/SceneFacts.h"

namespace tungsten::transport {

/// Why nothing is guided, whatever walks; empty where something may be.
std::string guidanceObstacle(const Policy& policy, const EffectPlan& facts);

/// How a medium is guided in. `aims`: at a target, not at a moment alone.
darts::Settings settingsIn(const Medium& medium, const Policy& policy, darts::Mode mode, bool aims = true);

/// Whether the directions of some medium come from a table. `aims` as above; false where nothing is guided.
Choice tablesOf(const Scene& scene, const Policy& policy, darts::Mode mode, const EffectPlan& facts, bool aims);

/// Every draw in every medium has a density that is known: plain walks can run beside guided ones.
bool haveDensities(const Scene& scene, const Policy& policy, darts::Mode mode);

} // namespace tungsten::transport
