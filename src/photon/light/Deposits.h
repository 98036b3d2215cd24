#pragma once
// What consecutive light paths leave behind, with each path's share.

#include "photon/primitives/VolumePrimitive.h"
#include "photon/surface/SurfaceArrival.h"

namespace tungsten::photon {

struct Deposits {
    explicit Deposits(const VolumePrimitive& primitive) : volume(depositsOf(primitive)) {}

    DepositList<Photon> surface;
    VolumeDeposits volume;
    std::vector<SurfaceArrival> arrivals;
    std::vector<float> worths; ///< of the vertices' connections, where these have no target yet

    void endPath() {
        surface.endPath();
        std::visit([](auto& list) { list.endPath(); }, volume);
    }
};

} // namespace tungsten::photon
