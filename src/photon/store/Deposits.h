#pragma once
// What consecutive light paths leave behind, with each path's share.

#include "photon/primitives/beams/PhotonBeam.h"

namespace tungsten::photon {

/// Photons of consecutive paths; pathEnds[i] is where path i's end.
struct DepositList {
    std::vector<Photon> photons;
    std::vector<uint32_t> pathEnds;
    void endPath() { pathEnds.push_back(uint32_t(photons.size())); }
};

/// Light that a connection brought to a sensor point.
struct SurfaceArrival {
    uint32_t point; ///< index in the SensorRecord
    int32_t frame;
    Vec3f from; ///< unit direction it came from
    Rgb light;  ///< of one path: times BSDF and cosine, radiance times the frame's width
};

struct Deposits {
    DepositList surface, volume;
    BeamList beams;
    std::vector<SurfaceArrival> arrivals;
    std::vector<float> worths; ///< of the vertices' connections, where these have no target yet

    void endPath() {
        surface.endPath();
        volume.endPath();
        beams.endPath();
    }
};

} // namespace tungsten::photon
