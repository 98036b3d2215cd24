#pragma once
// Kernels of photons near surfaces, folded back where they would reach beyond (docs/photon-primitives.md, section 2.8).

#include "photon/primitives/Radii.h"
#include "photon/store/Store.h"

#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/scene/Scene.h"

namespace tungsten::photon {

/// Ends kernels at the plane through the nearest point of a surface, and adds their mirror images behind it, which end
/// there, too: what one loses beyond the plane the other brings before it, for rays of any direction. Where a second
/// surface is as near on the other side, the radius ends there. What curved surfaces and corners still cut off is made
/// up for on average over directions. Records that no surface is near to stay as they are. `random`: of the pass.
void foldAtSurfaces(const Scene& scene, const Sampler& random, std::vector<Photon>& photons, Radii& radii,
                    const ProgressToken& watch);

} // namespace tungsten::photon
