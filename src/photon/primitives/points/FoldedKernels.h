#pragma once
// Kernels of photons near surfaces, folded back where they would reach beyond (docs/photon-primitives.md, section 2.8).

#include "photon/primitives/NearSurfaces.h"
#include "photon/primitives/Radii.h"
#include "photon/store/Store.h"

namespace tungsten::photon {

/// Ends kernels at the plane through the nearest point of a surface, and adds their mirror images behind it, which end
/// there, too: what one loses beyond the plane the other brings before it, for rays of any direction. Where a second
/// surface is as near on the other side, the radius ends there. What curved surfaces and corners still cut off is made
/// up for on average over directions. Records that no surface is near to, or that are out of view, stay as they are.
void foldAtSurfaces(const KernelEnds& ends, std::vector<Photon>& photons, Radii& radii);

} // namespace tungsten::photon
