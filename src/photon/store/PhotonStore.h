#pragma once
// Photons of one pass, and how many light paths they stand for.

#include "tungsten/core/Types.h"

#include <cstdint>
#include <vector>

namespace tungsten::photon {

/// A photon deposited in a medium (power after the collision, albedo included) or on a surface.
struct Photon {
    double time; ///< since the clock's zero: emission time plus time of flight
    Vec3f position;
    Vec3f direction; ///< of propagation, before the deposit
    Rgb power;       ///< of one path; the store's `scale` still divides it by the number of paths
    uint16_t bounce; ///< interactions from the light up to and including this one
    int16_t medium;  ///< index of the medium (volume photons), -1 on surfaces
};
static_assert(sizeof(Photon) == 48, "millions are stored: no padding");
/// Longest light path that a photon's bounce can tell.
inline constexpr int MostPhotonBounces = 65535;

/// A store takes whole paths: it is full when the next path no longer fits (StoreFilling.h).
struct StoreState {
    uint64_t paths = 0; ///< light paths that the content stands for
    bool full = false;

    [[nodiscard]] float scale() const { return paths > 0 ? float(1.0 / double(paths)) : 0.0f; }
};

/// Photons in path order, so the content does not depend on the number of threads.
struct PhotonStore : StoreState {
    std::vector<Photon> photons;
};

} // namespace tungsten::photon
