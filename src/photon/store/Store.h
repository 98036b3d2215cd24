#pragma once
// What light paths leave, and how many of them it stands for.

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

/// Records of consecutive paths; pathEnds[i] is where path i's end.
template <typename R>
struct DepositList {
    using Record = R;
    std::vector<R> records;
    std::vector<uint32_t> pathEnds;
    void endPath() { pathEnds.push_back(uint32_t(records.size())); }
};

/// Records of one pass in path order, so the content does not depend on the number of threads. A store takes whole
/// paths: it is full when the next path no longer fits (StoreFilling.h).
template <typename R>
struct Store {
    using Record = R;
    std::vector<R> records;
    uint64_t paths = 0; ///< light paths that the content stands for
    bool full = false;

    [[nodiscard]] float scale() const { return paths > 0 ? float(1.0 / double(paths)) : 0.0f; }
};

} // namespace tungsten::photon
