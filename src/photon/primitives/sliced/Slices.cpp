#include "photon/primitives/sliced/Slices.h"

#include "photon/primitives/ProgressiveSchedule.h"
#include "photon/primitives/sliced/SliceSplat.h"

namespace tungsten::photon {

double Slices::kernelWidth(const KernelSettings& settings, bool deltaGate, uint32_t step) {
    return flightRadiusFactor(settings, deltaGate, step);
}

Radii Slices::radii(const KernelSettings& settings, bool deltaGate, const std::vector<CollapsedFlights>&, uint32_t step,
                    const PassWatch&) {
    // Of the beams among them.
    return settings.volumeRadius * float(flightRadiusFactor(settings, deltaGate, step));
}

uint64_t Slices::splat(const Scene& scene, const transport::Sensor& sensor, const SensorRecord& record,
                       const Selection<CollapsedFlights>& slices, double scale, Film& film, const PassWatch& watch) {
    return splatSlices(scene, sensor, record, slices.records, slices.radii, scale, film, watch);
}

} // namespace tungsten::photon
