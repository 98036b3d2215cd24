#pragma once
// What consecutive light paths leave behind, with each path's share.

#include "photon/primitives/VolumePrimitive.h"
#include "photon/surface/ConnectionRecord.h"

#include "transport/Balance.h"

#include <optional>

namespace tungsten::photon {

/// What a record was weighed by beside the other strategy's paths.
struct Weighed {
    float weight = 1.0f;   ///< of the strategy's own estimate
    float logRatio = 0.0f; ///< log of the density of guided paths over that of plain ones
    transport::Found found = transport::Found::OnWay;
};
/// What pilot paths note of records: one of these for every record, in their order.
struct WeighedRecords {
    std::vector<Weighed> volume, surface, received;
};

struct Deposits {
    explicit Deposits(const VolumePrimitive& primitive) : volume(depositsOf(primitive)) {}

    DepositList<Photon> surface;
    VolumeDeposits volume;
    std::vector<ConnectionRecord> received;
    std::vector<float>
        expectedLight; ///< light of each vertex's connections, where nobody knows yet what one is to bring

    std::optional<WeighedRecords> weighed;

    [[nodiscard]] size_t volumeRecords() const {
        return std::visit([](const auto& list) { return list.records.size(); }, volume);
    }

    void endPath() {
        surface.endPath();
        std::visit([](auto& list) { list.endPath(); }, volume);
    }
};

} // namespace tungsten::photon
