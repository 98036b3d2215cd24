#pragma once
// What one task's light paths have left, and counted.

#include "photon/light/DepositVisitor.h"
#include "photon/light/Deposits.h"

namespace tungsten::photon {

struct TracedPaths {
    explicit TracedPaths(const VolumePrimitive& primitive) : deposits(primitive) {}
    Deposits deposits;
    PhotonCounters counters;
};

} // namespace tungsten::photon
