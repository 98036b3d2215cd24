#pragma once
// Late light that a limit on bounces cuts.

#include "tungsten/integrator/Features.h"

namespace tungsten {

/// Describes feature::LightCut: on where light that arrives before the sensor closes has been scattered
/// more often than `max_bounces` of its medium, or of the integrator, lets it be.
void describeBounceCuts(const Scene& scene, const SceneFacts& facts, Features& features);

} // namespace tungsten
