#include "photon/primitives/beams/Beams.h"

#include "photon/PhotonSettings.h"
#include "photon/Tuning.h"
#include "photon/primitives/ProgressiveSchedule.h"
#include "photon/primitives/beams/BeamSplat.h"
#include "photon/primitives/beams/CutBeams.h"

namespace tungsten::photon {

float Beams::reach(const KernelSettings& settings) {
    return settings.volumeRadius;
}

void Beams::read(const ObjectReader& block, const Scene& scene, PhotonSettings& settings) {
    settings.requireRadius(block, scene);
}

double Beams::kernelWidth(const KernelSettings& settings, bool deltaGate, uint32_t step) {
    return flightRadiusFactor(settings, deltaGate, step);
}

Radii Beams::radii(const KernelSettings& settings, bool deltaGate, const std::vector<PhotonBeam>&, uint32_t step,
                   const ProgressToken&) {
    return settings.volumeRadius * float(flightRadiusFactor(settings, deltaGate, step));
}

NearSurfaces Beams::nearSurfaces(const KernelSettings& settings, const Scene& scene) {
    return {scene, reach(settings), 1.0f + 0.5f * tuning::NearPartInRadii};
}

void Beams::endAtSurfaces(const KernelEnds& ends, std::vector<PhotonBeam>& beams, Radii& radii) {
    cutAtSurfaces(ends, beams, radii);
}

Selection<PhotonBeam> Beams::straight(const Scene& scene, const ArrivalCulling& culling,
                                      const std::vector<PhotonBeam>& beams, const Radii& radii) {
    Selection<PhotonBeam> seen;
    if (radii.single()) seen.radii = radii[0];
    for (size_t i = 0; i < beams.size(); ++i) {
        const auto part = straightPart(scene, culling, beams[i]);
        if (!part) continue;
        seen.records.push_back(*part);
        seen.radii.append(radii, i);
    }
    return seen;
}

double Beams::redirectedShare(const std::vector<PhotonBeam>& beams, const Radii& radii) {
    constexpr double MeanSine = 0.25 * double(Pi);
    ExpectedHits meeting;
    for (size_t i = 0; i < beams.size(); ++i) {
        const PhotonBeam& beam = beams[i];
        const float radius = radii[i];
        meeting.include(beam.base + beam.direction * beam.tStart, radius);
        meeting.include(beam.base + beam.direction * beam.tEnd, radius);
        meeting.addArea(MeanSine * 2.0 * double(radius) * double(beam.tEnd - beam.tStart));
    }
    return meeting.share();
}

uint64_t Beams::splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                      const Selection<PhotonBeam>& beams, double scale, Film& film, const ProgressToken& watch) {
    return splatBeams(scene, sensor, records, beams.records, beams.radii, scale, film, watch);
}

} // namespace tungsten::photon
