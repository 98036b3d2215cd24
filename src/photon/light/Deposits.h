#pragma once
// What consecutive light paths leave behind, with each path's share.

#include "photon/primitives/VolumePrimitive.h"
#include "photon/surface/ReceivedLight.h"

namespace tungsten::photon {

struct Deposits {
    explicit Deposits(const VolumePrimitive& primitive) : volume(depositsOf(primitive)) {}

    DepositList<Photon> surface;
    VolumeDeposits volume;
    std::vector<ReceivedLight> received;
    std::vector<float>
        expectedLight; ///< light of each vertex's connections, where nobody knows yet what one is to bring

    [[nodiscard]] size_t volumeRecords() const {
        return std::visit([](const auto& list) { return list.records.size(); }, volume);
    }

    void endPath() {
        surface.endPath();
        std::visit([](auto& list) { list.endPath(); }, volume);
    }
};

} // namespace tungsten::photon
