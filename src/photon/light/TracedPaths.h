#pragma once
// What one task's light paths have left, and counted.

#include "photon/light/DepositVisitor.h"
#include "photon/light/Deposits.h"

namespace tungsten::photon {

struct TracedPaths {
    explicit TracedPaths(const VolumePrimitive& primitive) : deposits(primitive) {}
    Deposits deposits;
    /// Counts by whose work it was: of plain paths, of what guided steps are asked about them, of guided paths.
    PhotonCounters plain, densities, guided;

    [[nodiscard]] uint64_t rays() const { return plain.rays + densities.rays + guided.rays; }
};

} // namespace tungsten::photon
