#pragma once
// What consecutive light paths leave behind, with each path's share.

#include "photon/PhotonBeam.h"

namespace tungsten::photon {

/// Photons of consecutive paths; pathEnds[i] is where path i's end.
struct DepositList {
    std::vector<Photon> photons;
    std::vector<uint32_t> pathEnds;
    void endPath() { pathEnds.push_back(uint32_t(photons.size())); }
};

/// Light that a pixel receives.
struct PixelContribution {
    uint32_t pixel;
    int32_t frame;
    Rgb radiance; ///< of one path, averaged over the frame
};

struct Deposits {
    DepositList surface, volume;
    BeamList beams;
    std::vector<PixelContribution> contributions;

    void endPath() {
        surface.endPath();
        volume.endPath();
        beams.endPath();
    }
};

} // namespace tungsten::photon
