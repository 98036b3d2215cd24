// What a photon map's plan says under --explain.

#include "photon/PhotonPlan.h"
#include "photon/view/CameraSubpath.h"

#include "transport/BoundedMedium.h"
#include "transport/EscapeModels.h"
#include "transport/SamplingSummary.h"
#include "transport/StepCounters.h"

#include "tungsten/integrator/Names.h"
#include "tungsten/integrator/SceneElements.h"

#include <cstdio>

namespace tungsten::photon {

void PhotonPlan::describeVolume(const PhotonSettings& settings, Features& features) const {
    const std::vector<std::string> type{"integrator.volume_photon_type"};
    forEachPrimitive(settings.primitive, [&](const auto& p) {
        using Primitive = std::decay_t<decltype(p)>;
        const bool used = std::holds_alternative<Primitive>(settings.primitive);
        const std::string other = std::visit([](const auto& q) { return std::string(q.Effect); }, settings.primitive);
        features.describe(p.Effect, used && volume.on, used ? volume.reason : "volumes store " + other, type,
                          {p.Stored});
    });
    if (volume.on && !settings.radiusReason.empty())
        features.describe("default radius", true, settings.radiusReason, {"integrator.volume_gather_radius"});
    describeSplatting(features);
}

void PhotonPlan::describeKernels(const Scene& scene, const PhotonSettings& settings, Features& features) const {
    const bool points = std::holds_alternative<Points>(settings.primitive),
               beams = std::holds_alternative<Beams>(settings.primitive), any = volume.on && (points || beams);
    const bool surfaces = !scene.primitives.empty();
    features.describe("kernels end at surfaces", any && surfaces && settings.boundaryKernels,
                      !volume.on  ? volume.reason
                      : !any      ? "neither points nor beams"
                      : !surfaces ? "there are none"
                      : settings.boundaryKernels
                          ? "what they would spread beyond, where nothing gathers it, stays before"
                          : "boundary_kernels is off: they reach beyond, where nothing gathers them",
                      {"integrator.boundary_kernels"}, {counter::EndedKernels});
    if (!any || (points && !settings.fixedVolumeRadius)) return;
    float densest = 0.0f;
    for (const Medium& medium : scene.media)
        if (medium.scatters() && medium.isHomogeneous()) densest = std::max(densest, maxComponent(medium.sigmaT()));
    if (!(densest > 0.0f)) return;
    // Light that falls away as exp(-x / mean free path): second derivatives are its square's inverse.
    const float freePaths = settings.volumeRadius * densest, blur = sqr(freePaths) / (points ? 16.0f : 6.0f);
    char text[200];
    std::snprintf(
        text, sizeof text,
        "radius %.3g, %.3g mean free paths of the densest medium: light that changes over one is off by some %.2g %%",
        double(settings.volumeRadius), double(freePaths), 100.0 * double(blur));
    features.describe("kernel blur", true, text, {"integrator.volume_gather_radius"});
}

void PhotonPlan::describeSplatting(Features& features) const {
    const bool splatted = volume.on && splats(), gathered = volume.on && (!splats() || indirectView);
    features.describe("splatting", splatted,
                      !volume.on ? volume.reason
                      : splatted ? "straight rays: every record visits the pixels that see it"
                                 : "rays are not straight, or not of one speed",
                      {"camera"}, {counter::SplattedRecords});
    features.describe("gathering", gathered,
                      !volume.on ? volume.reason
                      : gathered
                          ? std::string(splats() ? "redirected rays" : "rays") + " look for the records that they meet"
                          : "all rays are straight: records are splatted",
                      {"camera"}, {counter::GatheredRecords});
    features.describe("extra camera paths", extraCameraPaths.on, extraCameraPaths.reason, {"camera"});
}

void PhotonPlan::describeGuidance(const Scene& scene, const PhotonSettings& settings, Features& features) const {
    const std::vector<std::string> darts{"integrator.darts"};
    const bool atVertices = std::visit([](const auto& p) { return p.AtVertices; }, settings.primitive);
    features.describe("guided light paths", guidance.on, guidance.reason, darts,
                      atVertices ? std::vector<std::string>{counter::ControlVertices} : std::vector<std::string>{});
    features.describe("EDA table", edaTable.on, edaTable.reason, darts, {counter::DirectionTables});
    features.describe("surface connections", connections.on, connections.reason, darts, {counter::SurfaceConnections});
    features.describe("path reuse between pixels", connections.on,
                      connections.on ? "what a surface point receives is shared among neighbouring pixels"
                                     : connections.reason,
                      darts, {counter::SurfaceConnections});
    features.describe("glossy camera subpaths", glossyPaths.on, glossyPaths.reason,
                      elementsWithBsdf(scene, [](const Bsdf& bsdf) { return isGlossyOnly(bsdf); }).paths(),
                      {counter::GlossyCameraReflections});
    if (!guidance.on) return;
    features.describe("plain light paths beside guided ones", sideBySide.on, sideBySide.reason, darts,
                      {counter::PlainBesideGuided});
    if (!scene.transport.cameraUnwarped) transport::EscapeModels::plan(scene, settings.policy, features);
    const size_t bodies = settings.policy.followsBodies() ? transport::spheresAboutMedia(scene).size() : 0;
    features.describe("light towards bodies", bodies > 0,
                      bodies > 0 ? "a fifth of what lamps outside fog send goes towards " + std::to_string(bodies) +
                                       (bodies > 1 ? " bodies" : " body") + " of it"
                                 : "no body of fog in what does not scatter, or left alone",
                      darts);
    if (scene.transport.gate.frames > 1)
        features.describe("one frame per light path", oneFramePerPath.on, oneFramePerPath.reason, darts,
                          {counter::FramesAimedAt});
    features.describe("photons with control vertices", photonsWithControlVertices.on, photonsWithControlVertices.reason,
                      darts);
}

SamplingSummary PhotonPlan::summary(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts) const {
    const transport::Policy& policy = settings.policy;
    SamplingSummary said;
    said.paths = transport::describeStrategies("light paths", guidance, sideBySide, policy.plainShare);
    said.vertices = guidance.on ? transport::describeVertices(scene, policy, darts::Mode::Photon, facts,
                                                              !scene.transport.cameraUnwarped)
                                : transport::PlainVertices;
    const auto [stored, atVertices] = std::visit(
        [](const auto& p) { return std::pair(std::string(p.Effect), bool(p.AtVertices)); }, settings.primitive);
    said.ends = transport::describeEnds(
        {{volume.on, stored + " (" + volume.reason + "), " + (splats() ? "splatted" : "gathered")},
         {volume.on && !settings.radiusReason.empty(), "default radius: " + settings.radiusReason},
         {guidance.on && atVertices && policy.sampling.elliptical,
          photonsWithControlVertices.on ? "control vertices beside them"
                                        : "control vertices alone: " + photonsWithControlVertices.reason},
         {connections.on, "connections to surface points that the camera sees in time"},
         {surfacePhotons.on,
          connections.on ? "surface photons for what connections cannot bring" : "surface photons, gathered"},
         {glossyPaths.on, glossyPaths.reason},
         {detectorLight.on, detectorLight.reason}});
    return said;
}

void PhotonPlan::describe(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts,
                          Features& features) const {
    transport::countSteps(features);
    features.sampling = summary(scene, settings, facts);
    describeVolume(settings, features);
    describeKernels(scene, settings, features);
    features.describe("temporal kernel", temporalKernel.on, temporalKernel.reason, {"integrator.delta_time_gate"});
    features.describe("surface photons", surfacePhotons.on, surfacePhotons.reason,
                      elementsWithLobe(scene, lobe::Smooth).paths(),
                      {counter::StoredSurfacePhotons, counter::GatheredOnSurfaces});
    if (scene.camera.detectors())
        features.describe("lights at detectors", detectorLight.on, detectorLight.reason, {"camera"},
                          {counter::ArrivalsAtDetectors});
    describeGuidance(scene, settings, features);
    features.describe("exact arrival culling", exactCulling.on, exactCulling.reason, {"integrator"});
}

} // namespace tungsten::photon
