#pragma once
// Settings of the path tracer's integrator block.

#include "transport/Policy.h"

#include "tungsten/scene/ObjectReader.h"
#include "tungsten/scene/Scene.h"

namespace tungsten::path {

struct PathSettings {
    bool lightSampling = true;       ///< connect surface vertices to emitters
    bool volumeLightSampling = true; ///< connect medium vertices to emitters
    bool lowOrderScattering = true;  ///< false: nothing from paths with exactly one medium scatter
    bool includeSurfaces = true;     ///< false: nothing that reaches surfaces without a medium scatter
    bool russianRoulette = true;
    transport::Policy policy; ///< what is asked for; PathPlan says what is done
};

/// Reads the block; problems and warnings go to the reader's diagnostics.
PathSettings readPathSettings(const ObjectReader& block, const Scene& scene);

} // namespace tungsten::path
