#pragma once
// Photon beams: flights of light paths through a scattering medium.

#include "photon/store/ArrivalCulling.h"
#include "photon/store/Store.h"

namespace tungsten::photon {

/// A flight from a light, a medium vertex or a surface. It stands for every collision along its stored part: the power
/// that collides per unit of length at s is power sigma_s T(s), with s and T measured from the base (long beams,
/// docs/photon-primitives.md, section 2.2).
struct PhotonBeam {
    double time; ///< at the base, since the clock's zero
    Vec3f base;
    Vec3f direction;
    Rgb power;          ///< leaving the base, of one path; the store's `scale` still divides it by the number of paths
    float tStart, tEnd; ///< stored part, distances from the base
    uint16_t bounce;    ///< interactions from the light up to and including the base
    int16_t medium;     ///< index of the medium the flight crosses
};
static_assert(sizeof(PhotonBeam) == 56, "millions are stored: no padding");

/// Beyond it nothing of a flight shows in a float.
float visibleReach(const Medium& medium);

/// The part of a flight that camera subpaths can see inside the gate, if there is one. `flight` runs from tStart to
/// tEnd, the next surface (Infinity if there is none).
std::optional<PhotonBeam> clippedBeam(const ArrivalCulling& culling, const Medium& medium, PhotonBeam flight);

/// The part of a beam that camera subpaths without mirror or refraction can see inside the gate, if there is one; needs
/// culling.straightTimesKnown().
std::optional<PhotonBeam> straightPart(const Scene& scene, const ArrivalCulling& culling, PhotonBeam beam);

} // namespace tungsten::photon
