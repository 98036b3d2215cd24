#include "photon/primitives/points/Points.h"

#include "photon/PhotonSettings.h"
#include "photon/primitives/ProgressiveSchedule.h"
#include "photon/primitives/points/FoldedKernels.h"
#include "photon/primitives/points/PointGather.h"
#include "photon/primitives/points/PointSplat.h"

namespace tungsten::photon {

float Points::reach(const KernelSettings& settings) {
    return settings.fixedVolumeRadius ? settings.volumeRadius : Infinity;
}

void Points::read(const ObjectReader& block, const Scene& scene, PhotonSettings& settings) {
    if (settings.fixedVolumeRadius) settings.requireRadius(block, scene);
}

double Points::kernelWidth(const KernelSettings& settings, bool, uint32_t step) {
    const auto factor = double(pointRadiusFactor(step, settings.volumeAlpha));
    return settings.fixedVolumeRadius ? factor : std::sqrt(factor);
}

Radii Points::radii(const KernelSettings& settings, bool, const std::vector<Photon>& photons, uint32_t step,
                    const ProgressToken& watch) {
    const float factor = pointRadiusFactor(step, settings.volumeAlpha);
    if (settings.fixedVolumeRadius) return settings.volumeRadius * factor;
    std::vector<float> radii = adaptiveRadii(photons, watch);
    // The schedule's cube root acts on the squared radius here (docs/scene-format.md, section 10.5).
    for (float& radius : radii) radius *= std::sqrt(factor);
    return radii;
}

NearSurfaces Points::nearSurfaces(const KernelSettings& settings, const Scene& scene) {
    return {scene, reach(settings), 1.0f};
}

void Points::endAtSurfaces(const KernelEnds& ends, std::vector<Photon>& photons, Radii& radii) {
    foldAtSurfaces(ends, photons, radii);
}

Selection<Photon> Points::straight(const Scene&, const ArrivalCulling& culling, const std::vector<Photon>& photons,
                                   const Radii& radii) {
    Selection<Photon> seen;
    if (radii.single()) seen.radii = radii[0];
    for (size_t i = 0; i < photons.size(); ++i) {
        if (!culling.seenStraight(photons[i].position, photons[i].time)) continue;
        seen.records.push_back(photons[i]);
        seen.radii.append(radii, i);
    }
    return seen;
}

double Points::redirectedShare(const std::vector<Photon>& photons, const Radii& radii) {
    ExpectedHits meeting;
    for (size_t i = 0; i < photons.size(); ++i) {
        meeting.include(photons[i].position, radii[i]);
        meeting.addArea(double(Pi * radii[i] * radii[i]));
    }
    return meeting.share();
}

uint64_t Points::splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                       const Selection<Photon>& photons, double scale, Film& film, const ProgressToken& watch) {
    return splatPhotons(scene, sensor, records, photons.records, photons.radii, scale, film, watch);
}

} // namespace tungsten::photon
