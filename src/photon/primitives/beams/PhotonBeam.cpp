#include "photon/primitives/beams/PhotonBeam.h"

namespace tungsten::photon {

/// Beyond an optical depth of 60 in every channel that scatters, nothing shows in a float.
float visibleReach(const Medium& medium) {
    constexpr float OpticalDepth = 60.0f;
    float reach = 0.0f;
    for (int channel = 0; channel < 3; ++channel)
        if (medium.sigmaS()[channel] > 0.0f) reach = std::max(reach, OpticalDepth / medium.sigmaT()[channel]);
    return reach;
}

std::optional<PhotonBeam> clippedBeam(const ArrivalCulling& culling, const Medium& medium, PhotonBeam flight) {
    flight.tEnd = std::min(flight.tEnd, visibleReach(medium));
    const FlightPart part =
        culling.countingPart(flight.base, flight.direction, flight.time, double(medium.speedOfLight));
    flight.tStart = std::max(flight.tStart, float(part.start));
    flight.tEnd = std::min(flight.tEnd, float(part.end));
    if (!(flight.tStart < flight.tEnd)) return std::nullopt;
    return flight;
}

std::optional<PhotonBeam> straightPart(const Scene& scene, const ArrivalCulling& culling, PhotonBeam beam) {
    const double speed = double(scene.media[size_t(beam.medium)].speedOfLight);
    const FlightPart part = culling.straightPart(beam.base, beam.direction, beam.time, speed);
    beam.tStart = std::max(beam.tStart, float(part.start));
    beam.tEnd = std::min(beam.tEnd, float(part.end));
    if (!(beam.tStart < beam.tEnd)) return std::nullopt;
    return beam;
}

} // namespace tungsten::photon
