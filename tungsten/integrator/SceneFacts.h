#pragma once
// What a scene calls for, in values. Integrators build only what the facts ask for; Features.h has the sentences.

#include "tungsten/scene/Scene.h"

#include <string>
#include <vector>

namespace tungsten {

struct SceneFacts {
    bool timeResolved = false; ///< gated or frames
    bool multipleFrames = false;
    bool mediumScattering = false;       ///< some medium a path can reach, in time, scatters
    bool surfaceScattering = false;      ///< some surface has a smooth lobe
    bool specularCameraSubpaths = false; ///< mirrors or refraction exist: camera subpaths can fold
    bool speedsDiffer = false;           ///< light travels at different speeds in different regions
    float highestSpeed = 1.0f;           ///< of light, in any region that a path can reach
    bool greyMedia = true;               ///< all media have equal coefficients in all channels
    std::vector<int> heterogeneousMedia; ///< that a path can reach and whose coefficients vary
    bool forwardBoundaries = false;      ///< index-matched boundaries: shadow rays must look through them
    bool surfaceEmission = false;        ///< emitters that camera rays can hit
    bool environment = false;
    bool textures = false;

    /// `--effects all`: stages run that the scene does not call for, and nothing is excluded. The image is the same.
    bool everything = false;
    std::vector<bool> excludedEmitters; ///< their light arrives after the gate; empty: none is known to
    bool nothingArrives = false;        ///< all emitters are late: the image is black, and not rendered
    bool surfacesOutOfTime = false;     ///< whatever surfaces show arrives after the gate
    std::vector<bool> excludedMedia;    ///< what they scatter arrives after the gate; empty: none is known to
    int emptyFrames = 0;                ///< so many frames end before any light can arrive

    [[nodiscard]] bool isExcluded(size_t medium) const { return !excludedMedia.empty() && excludedMedia[medium]; }
};

/// Whatever the integrator, before anything is excluded (EarliestArrival.h). `everything`: SceneFacts::everything.
SceneFacts analyseScene(const Scene& scene, bool everything = false);

} // namespace tungsten
