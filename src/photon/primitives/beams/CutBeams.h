#pragma once
// Beams cut where they come near surfaces, which end their ribbons there (docs/photon-primitives.md, section 2.8).

#include "photon/primitives/NearSurfaces.h"
#include "photon/primitives/Radii.h"
#include "photon/primitives/beams/PhotonBeam.h"

#include "tungsten/integrator/ProgressToken.h"

namespace tungsten::photon {

/// Each beam becomes parts without a surface within the radius, which are as before, and parts of at most
/// tuning::NearPartInRadii, which know the planes of the surfaces about their middles: what of the ribbon lies before
/// them is the kernel there. These are narrower, tuning::WidthAtSurfaces, and no wider than the room between two
/// surfaces. What curved surfaces and corners still cut off is made up for on average. Beams out of view are left out.
void cutAtSurfaces(const KernelEnds& ends, std::vector<PhotonBeam>& beams, Radii& radius);

} // namespace tungsten::photon
