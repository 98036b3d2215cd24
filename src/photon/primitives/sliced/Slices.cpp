#include "photon/primitives/sliced/Slices.h"

#include "photon/PhotonSettings.h"
#include "photon/primitives/ProgressiveSchedule.h"

namespace tungsten::photon {

Radii Slices::radii(const PhotonSettings& settings, bool deltaGate, const std::vector<CollapsedFlights>&,
                    uint32_t step) {
    // Of the beams among them.
    return settings.volumeRadius *
           (deltaGate ? float(deltaGateFactor(step, settings.volumeAlpha)) : beamRadiusFactor(step, settings.alpha));
}

} // namespace tungsten::photon
