#pragma once
// Settings of the path tracer's integrator block.

#include "path/MissedLight.h"
#include "transport/BounceLimits.h"
#include "transport/Policy.h"

#include "tungsten/reader/ObjectReader.h"
#include "tungsten/scene/Scene.h"

namespace tungsten::path {

struct PathSettings {
    bool lightSampling = true;       ///< connect surface vertices to emitters
    bool volumeLightSampling = true; ///< connect medium vertices to emitters
    transport::BounceLimits limits;
    bool russianRoulette = true;
    transport::Policy policy; ///< what is asked for; PathPlan says what is done
    std::optional<MissedLight> missed;
};

/// What all integrators of this plugin read: max_bounces and its like are the scene's already.
transport::BounceLimits readBounceLimits(const ObjectReader& block, const Scene& scene);
bool readRussianRoulette(const ObjectReader& block, bool timeResolved);
/// Settings of the photon integrators: a scene may switch between them and this plugin's by its type alone.
void acceptPhotonSettings(const ObjectReader& block);

/// Reads the block; problems and warnings go to the reader's diagnostics.
PathSettings readPathSettings(const ObjectReader& block, const Scene& scene);

} // namespace tungsten::path
