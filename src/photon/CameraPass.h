#pragma once
// The camera pass: camera rays gather what the photon pass has left.

#include "photon/light/PhotonPass.h"
#include "photon/primitives/VolumeGather.h"
#include "photon/store/NearestPhotons.h"
#include "photon/view/GlossyLight.h"

namespace tungsten::photon {

/// Structures over one pass's photons, and the pass's radii.
struct GatherStructures {
    const Store<Photon>& surfacePhotons;
    transport::TimeSensor sensor; ///< its gate is the pass's: the scene's, or a delta gate's temporal kernel
    bool splatted = false;        ///< straight rays have their volume photons or beams already
    bool includeSurfaces = true;
    CameraSubpathRules rules{};
    const GlossyLight* glossy = nullptr; ///< with rules.glossy
    uint32_t gatherCount = 0;
    float surfaceRadius = 0.0f;
    float kernel = 1.0f; ///< width of kernels, of what the schedule says
    VolumeGathers volume{};
    std::unique_ptr<NearestPhotons> surfaces{}; ///< null when there is no surface photon
};

/// Adds the image of every frame to the film's pass image: of one sample per pixel, whose paths have been recorded, or
/// of all the pass's.
void renderCameraPass(const Scene& scene, const GatherStructures& structures, const CameraRecord* record,
                      const PassInfo& pass, Film& film, Statistics& statistics);

/// What camera paths leave whatever light paths do: the variance of an image of one a pixel that shows lights alone,
/// times the squared width of the gate, summed over pixels and frames. `structures` have no photons.
double varianceOfLightsInView(const Scene& scene, const GatherStructures& structures, const PassInfo& pass);

} // namespace tungsten::photon
