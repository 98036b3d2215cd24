#include "tungsten/integrator/SceneFacts.h"

#include "tungsten/integrator/SceneElements.h"

namespace tungsten {

namespace {

void analyseMedia(const Scene& scene, SceneFacts& facts) {
    for (const int index : reachableMedia(scene)) {
        const Medium& medium = scene.media[size_t(index)];
        if (medium.scatters()) facts.mediumScattering = true;
        if (!medium.isGrey()) facts.greyMedia = false;
        if (!medium.isHomogeneous()) facts.heterogeneousMedia.push_back(index);
    }
}

void analyseSurfaces(const Scene& scene, SceneFacts& facts) {
    facts.surfaceScattering = elementsWithLobe(scene, lobe::Smooth).any();
    facts.specularCameraSubpaths = elementsWithLobe(scene, lobe::Specular).any();
    facts.forwardBoundaries = elementsWithLobe(scene, lobe::Forward).any();
    facts.textures = elementsWithTexture(scene).any();
}

void analyseEmission(const Scene& scene, SceneFacts& facts) {
    for (const Emitter& emitter : scene.emitters) {
        if (emitter.primitive())
            facts.surfaceEmission = true;
        else if (emitter.isInfinite())
            facts.environment = true;
    }
}

} // namespace

SceneFacts analyseScene(const Scene& scene, bool everything) {
    const TimeGate& gate = scene.transport.gate;
    const Speeds speeds = reachableSpeeds(scene);
    SceneFacts facts;
    facts.everything = everything;
    facts.timeResolved = !gate.steadyState;
    facts.multipleFrames = gate.frames > 1;
    facts.speedsDiffer = facts.timeResolved && speeds.lowest < speeds.highest;
    facts.highestSpeed = speeds.highest;
    analyseMedia(scene, facts);
    analyseSurfaces(scene, facts);
    analyseEmission(scene, facts);
    return facts;
}

} // namespace tungsten
