#include "photon/PhotonPlan.h"

#include "photon/Tuning.h"
#include "photon/view/CameraSubpath.h"

#include "transport/BoundedMedium.h"
#include "transport/EscapeModels.h"
#include "transport/GuidancePlan.h"
#include "transport/SamplingSummary.h"
#include "transport/StepCounters.h"

#include "tungsten/integrator/Names.h"
#include "tungsten/integrator/SceneElements.h"

#include <cstdio>

namespace tungsten::photon {

namespace {

/// What a plan is made from.
struct Given {
    const Scene& scene;
    const PhotonSettings& settings;
    const SceneFacts& facts;

    [[nodiscard]] const transport::Policy& policy() const { return settings.policy; }
    [[nodiscard]] bool unwarped() const { return scene.transport.cameraUnwarped; }
    [[nodiscard]] bool delta() const { return scene.transport.gate.delta; }
    /// A constant of the primitive that volumes store.
    template <typename Ask>
    [[nodiscard]] auto ofPrimitive(Ask ask) const {
        return std::visit(ask, settings.primitive);
    }
    /// Volumes store points, which light paths leave at their vertices.
    [[nodiscard]] bool atVertices() const {
        return ofPrimitive([](const auto& p) { return p.AtVertices; });
    }
};

bool anyGlossyOnly(const Scene& scene) {
    const auto glossy = [](const BsdfPtr& bsdf) { return isGlossyOnly(*bsdf); };
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
        return std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(), glossy);
    });
}

// Each of these says what is done, and why.

Decision guidanceOf(const Given& given) {
    std::string obstacle = transport::guidanceObstacle(given.scene, given.policy(), given.facts);
    if (!obstacle.empty()) return {false, obstacle};
    obstacle =
        given.ofPrimitive([&](const auto& p) { return p.guidanceObstacle(given.scene, given.facts.speedsDiffer); });
    if (!obstacle.empty()) return {false, obstacle};
    const bool needsPlace = given.ofPrimitive([](const auto& p) { return p.NeedsPlace; }) || !given.unwarped();
    const bool on = !needsPlace || !given.scene.camera.hasParallelRays();
    return {on, on ? "the scene asks for DARTS" : "parallel rays, or detectors, have no one position to aim at"};
}

Decision surfacesOf(const Given& given) {
    if (given.facts.surfacesOutOfTime) return {false, "what surfaces show arrives after the sensor has closed"};
    const bool on = given.settings.includeSurfaces && given.facts.surfaceScattering;
    return {on, on ? "smooth surfaces are gathered" : "include_surfaces is false, or no surface has a smooth lobe"};
}

Decision glossyPathsOf(const Given& given, const PhotonPlan& plan) {
    if (!plan.guidance.on) return plan.guidance;
    if (const Decision surfaces = surfacesOf(given); !surfaces.on) return surfaces;
    // Time without camera segments ends at the first surface that is no mirror.
    const bool on = anyGlossyOnly(given.scene) && !given.unwarped() && given.policy().followsGlossy();
    return {on, on ? "camera subpaths go on at surfaces that are glossy only, as at mirrors"
                   : "no surface is glossy without being diffuse, or camera_unwarped, the preset or "
                     "glossy_sensor_paths leaves them to photons"};
}

Decision oneFramePerPathOf(const Given& given, bool exact) {
    const bool manyFrames = given.ofPrimitive([](const auto& p) { return p.ManyFrames; });
    const bool on =
        exact && !manyFrames && given.scene.transport.gate.frames > 1 && given.policy().aimsAtSingleFrames();
    return {on, on ? "each light path aims at one frame" : "light paths aim at the whole sequence as one gate"};
}

Decision sideBySideOf(const Given& given, const PhotonPlan& plan) {
    const transport::Policy& policy = given.policy();
    if (plan.guidance.on && (policy.plainShare == 0.0f || policy.directView == transport::DirectView::On))
        return {false, "plain_share is 0, or direct_view asks for control vertices alone"};
    return transport::balanceOf(given.scene, policy, darts::Mode::Photon, plan.guidance,
                                !plan.oneFramePerPath.on && !plan.meetsDeltaGate);
}

Decision photonsWithControlVerticesOf(const Given& given, const PhotonPlan& plan) {
    // What is drawn for one moment, or by the sensor's response, no ordinary photon is found by as well.
    const bool complete = plan.directView && (plan.meetsDeltaGate || plan.drawsByResponse ||
                                              given.policy().directView != transport::DirectView::Auto ||
                                              given.policy().sampling.published);
    const bool on = given.atVertices() && (plan.sideBySide.on || !complete);
    return {on, on ? "they share with control vertices by the balance heuristic"
                   : "control vertices alone are complete, or no points are stored"};
}

Decision connectionsOf(const Given& given, const PhotonPlan& plan) {
    if (!plan.guidance.on) return plan.guidance;
    if (const Decision surfaces = surfacesOf(given); !surfaces.on) return surfaces;
    const bool on = plan.straightRays && given.policy().connectsSurfaces();
    return {on, on ? "light paths connect to the surface points that the camera sees in time"
                   : "a thin lens, different speeds of light, the preset or surface_connections leaves surfaces to "
                     "photons"};
}

Decision volumeOf(const Given& given, const PhotonPlan& plan) {
    const bool constant = plan.homogeneous || given.atVertices(), on = given.facts.mediumScattering && constant;
    if (!on) return {on, constant ? whyNoScattering(given.facts) : heterogeneity(given.scene, given.facts)};
    const std::string& chosen = given.settings.primitiveReason;
    return {on, chosen.empty() ? given.ofPrimitive([](const auto& p) { return std::string(p.Reason); }) : chosen};
}

Decision temporalKernelOf(const Given& given, const PhotonPlan& plan) {
    const bool on = given.delta();
    return {on, !on ? "the gate has a width, or none"
                : plan.meetsDeltaGate && given.atVertices()
                    ? "delta gate: a box about it that narrows with the radius; "
                      "control vertices lie on the gate itself"
                    : "delta gate: a box about it that narrows with the radius"};
}

Decision surfacePhotonsOf(const Given& given, const PhotonPlan& plan) {
    Decision surfaces = surfacesOf(given);
    if (surfaces.on && plan.connections.on)
        surfaces.reason = "for what connections cannot bring: light by way of mirrors or refraction or of a single "
                          "direction, and to glossy surfaces";
    return surfaces;
}

Decision exactCullingOf(const Given& given, const PhotonPlan& plan) {
    const bool on = given.facts.timeResolved && plan.straightRays && !plan.indirectView;
    return {
        on,
        on ? "direct view: photons that arrive outside the gate are not stored"
           : "steady state, or camera subpaths that are redirected, change speed or start at many points: photons are "
             "tested when gathered"};
}

/// Number of camera subpaths for each sample of a pixel that take little time; at least one.
uint32_t affordedCameraPaths(const Given& given) {
    const Vec2i& resolution = given.scene.camera.resolution;
    const uint64_t pixels = uint64_t(resolution.x) * uint64_t(resolution.y);
    const uint64_t paths = std::min<uint64_t>(tuning::CameraPaths, given.settings.volumePhotonCount);
    const bool slices = given.ofPrimitive([](const auto& p) { return p.LimitsRecords; });
    return uint32_t(std::clamp<uint64_t>(paths / pixels, 1, slices ? tuning::MostWithSlices : tuning::MostCameraPaths));
}

Decision extraCameraPathsOf(const Given& given, const PhotonPlan& plan, uint32_t paths) {
    const bool on = paths > 1 && given.policy().guides() && !given.policy().sampling.published && !plan.glossyPaths.on;
    return {on, on ? std::to_string(paths) + " for each sample of a pixel: the image is small, and they take little "
                                             "time beside light paths"
                   : "many pixels or few light paths, paths on from glossy surfaces, which take long, or no DARTS "
                     "but the published one"};
}

} // namespace

PhotonPlan PhotonPlan::of(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts) {
    const Given given{scene, settings, facts};
    PhotonPlan plan;
    plan.highestSpeed = facts.highestSpeed;
    plan.excludedEmitters = facts.excludedEmitters;
    plan.excludedMedia = facts.excludedMedia;
    plan.emptyFrames = facts.emptyFrames;
    plan.oneSpeed = !facts.speedsDiffer;
    plan.homogeneous = facts.heterogeneousMedia.empty();
    plan.straightRays = scene.camera.hasSinglePosition() && plan.oneSpeed;
    plan.guidance = guidanceOf(given);
    plan.edaTable =
        transport::tablesOf(scene, settings.policy, darts::Mode::Photon, facts, plan.guidance.on && !given.unwarped());
    plan.glossyPaths = glossyPathsOf(given, plan);
    plan.indirectView = facts.specularCameraSubpaths || plan.glossyPaths.on;
    plan.gathersAfterSplat = settings.includeSurfaces;
    plan.chooseGuidance(scene, settings, facts);
    plan.connections = connectionsOf(given, plan);
    plan.detectorLight = transport::detectorLightOf(scene, facts, settings.includeSurfaces);
    plan.chooseStores(scene, settings, facts);
    return plan;
}

void PhotonPlan::chooseGuidance(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts) {
    const Given given{scene, settings, facts};
    const bool straight = !indirectView && oneSpeed;
    directView = settings.policy.directView == transport::DirectView::Auto
                     ? straight
                     : settings.policy.directView == transport::DirectView::On;
    const bool pointLike = given.unwarped() || scene.camera.aperture() == 0.0f;
    const bool exact = guidance.on && directView && straight && pointLike;
    oneFramePerPath = oneFramePerPathOf(given, exact);
    drawsByResponse = exact && !scene.transport.response.empty();
    meetsDeltaGate = exact && given.delta() && settings.policy.sampling.elliptical;
    sideBySide = sideBySideOf(given, *this);
    photonsWithControlVertices = photonsWithControlVerticesOf(given, *this);
}

void PhotonPlan::chooseStores(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts) {
    const Given given{scene, settings, facts};
    const bool oneTime = oneSpeed || given.unwarped();
    primitiveSplats = given.ofPrimitive([&](const auto& p) { return p.splats(straightRays, oneTime); });
    volume = volumeOf(given, *this);
    const uint32_t afforded = affordedCameraPaths(given);
    extraCameraPaths = extraCameraPathsOf(given, *this, afforded);
    cameraPaths = extraCameraPaths.on ? afforded : 1;
    temporalKernel = temporalKernelOf(given, *this);
    surfacePhotons = surfacePhotonsOf(given, *this);
    exactCulling = exactCullingOf(given, *this);
}

// ---- What it says under --explain

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
