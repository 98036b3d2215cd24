#pragma once
// The sensor pass: camera rays gather what the photon pass has left.

#include "photon/light/PhotonPass.h"
#include "photon/primitives/beams/BeamGather.h"
#include "photon/primitives/points/PointGather.h"
#include "photon/store/NearestPhotons.h"
#include "photon/view/GlossyLight.h"

namespace tungsten::photon {

/// Structures over one pass's photons, and the pass's radii.
struct GatherStructures {
    const PhotonMaps& maps;
    Sensor sensor;         ///< its gate is the pass's: the scene's, or a delta gate's temporal kernel
    bool splatted = false; ///< straight rays have their volume photons or beams already
    bool includeSurfaces = true;
    SensorPathRules rules{};
    const GlossyLight* glossy = nullptr; ///< with rules.glossy
    uint32_t gatherCount = 0;
    float surfaceRadius = 0.0f;
    std::unique_ptr<PointGather> points{}; ///< null when there is no volume photon
    /// Those that a straight sensor path can see inside the gate, where sensor paths can also fold; null: `points`
    /// serves both.
    std::unique_ptr<PointGather> straightPoints{};
    std::unique_ptr<BeamGather> beams{};         ///< null when there is no photon beam
    std::unique_ptr<BeamGather> straightBeams{}; ///< as straightPoints
    std::unique_ptr<NearestPhotons> surfaces{};  ///< null when there is no surface photon
    /// `points` or `beams` dealt to the highlight paths of a pixel: each gathers its own part on folded rays. Empty
    /// unless splatted, with rules.glossy.
    std::vector<std::unique_ptr<PointGather>> pointParts{};
    std::vector<std::unique_ptr<BeamGather>> beamParts{};
};

/// Adds the image of every frame to the film's pass image.
void renderSensorPass(const Scene& scene, const GatherStructures& structures, const PassInfo& pass, Film& film,
                      Statistics& statistics);

} // namespace tungsten::photon
