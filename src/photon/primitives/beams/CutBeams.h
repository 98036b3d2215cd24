#pragma once
// Beams cut where they come near surfaces, which end their ribbons there (docs/photon-primitives.md, section 2.8).

#include "photon/primitives/NearSurfaces.h"
#include "photon/primitives/Radii.h"
#include "photon/primitives/beams/PhotonBeam.h"

#include "tungsten/integrator/ProgressToken.h"

namespace tungsten::photon {

namespace tuning {

/// Beams near a surface are cut into parts of so many radii, at most. Room of thin fog, CPU time and variance over
/// those without ended kernels, 1 s: 1.65, 1.005 at 4 and 1.70, 1.009 at 8 with cells of 4 radii; 1.71, 1.010 at 8
/// and 1.68, 1.020 at 16 with cells of 2. At 3 s 4 takes longer. Bench: benchmarks/kernels/cost.py
inline constexpr float NearPartInRadii = 8.0f;

} // namespace tuning

/// Each beam becomes parts without a surface within the radius, which are as before, and parts of at most
/// tuning::NearPartInRadii, which know the planes of the surfaces about their middles: what of the ribbon lies before
/// them is the kernel there. These are narrower, tuning::WidthAtSurfaces, and no wider than the room between two
/// surfaces. What curved surfaces and corners still cut off is made up for on average. Beams out of view are left out.
void cutAtSurfaces(const KernelEnds& ends, std::vector<PhotonBeam>& beams, Radii& radius);

} // namespace tungsten::photon
