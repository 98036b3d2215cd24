#pragma once
// Late light that a limit on bounces cuts.

#include "tungsten/integrator/SceneFacts.h"

namespace tungsten {

/// Describes the effect LightCut in the plan: on where light that arrives before the sensor closes has been scattered
/// more often than `max_bounces` of its medium, or of the integrator, lets it be. plan.highestSpeed must be known.
void planBounceCuts(const Scene& scene, EffectPlan& plan);

inline constexpr const char* LightCut = "late light cut by max_bounces";

} // namespace tungsten
