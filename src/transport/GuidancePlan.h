#pragma once
// What the plans of all guided walks ask in common, of camera paths and of light paths.

#include "transport/Policy.h"

#include "tungsten/integrator/Features.h"

namespace tungsten::transport {

/// Why nothing is guided, whatever walks; empty where something may be.
std::string guidanceObstacle(const Scene& scene, const Policy& policy, const SceneFacts& facts);

/// How a medium is guided in. `aims`: at a target, not at a moment alone.
darts::Settings settingsIn(const Medium& medium, const Policy& policy, darts::Mode mode, bool aims = true);

/// Whether the directions of some medium come from a table. `aims` as above; false where nothing is guided.
Decision tablesOf(const Scene& scene, const Policy& policy, darts::Mode mode, const SceneFacts& facts, bool aims);

/// Whether plain walks run beside guided ones. `meets`: they meet what those aim at.
Decision balanceOf(const Scene& scene, const Policy& policy, darts::Mode mode, const Decision& guidance, bool meets);

/// Whether places of detectors are connected to lights, where paths without scattering are `shown`.
Decision detectorLightOf(const Scene& scene, const SceneFacts& facts, bool shown);

} // namespace tungsten::transport
