#include "photon/PhotonPlan.h"

#include "photon/Tuning.h"
#include "photon/view/SensorPath.h"

#include "transport/Body.h"
#include "transport/StepCounters.h"
#include "transport/WaysOut.h"

#include "tungsten/render/SceneUses.h"

namespace tungsten::photon {

namespace {

constexpr const char* OutOfTime = "what surfaces show arrives after the sensor has closed";

/// Media whose directions come from a table.
Choice tablesOf(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts, const Choice& guidance) {
    if (!guidance.on) return {false, "light paths are not guided"};
    if (scene.transport.cameraUnwarped) return {false, "camera_unwarped: there is nothing to aim at"};
    const auto tabled = [&](const Medium& medium) {
        return medium.scatters() &&
               settings.policy.sampling
                       .settings(darts::Mode::Photon, medium.phase.g(), medium.guided, medium.guidedPhase)
                       .direction == darts::Direction::Eda;
    };
    bool any = false;
    for (size_t i = 0; i < scene.media.size(); ++i) any = any || (tabled(scene.media[i]) && !facts.isOutOfTime(i));
    return {any, any ? "directions are drawn from the published table" : "directions come from closed forms"};
}

bool anyGlossyOnly(const Scene& scene) {
    const auto glossy = [](const BsdfPtr& bsdf) { return isGlossyOnly(*bsdf); };
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
        return std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(), glossy);
    });
}

std::string guidanceObstacle(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts) {
    if (!settings.policy.guides()) return "the scene does not ask for it";
    if (!facts.timeResolved) return "steady state: there is no gate to aim at";
    if (!facts.mediumScattering) return facts.noScattering();
    if (!facts.heterogeneousMedia.empty()) return facts.heterogeneity();
    const auto own = [&](const auto& primitive) -> std::string {
        const std::string obstacle = primitive.guidanceObstacle(scene, facts.speedsDiffer);
        if (!obstacle.empty()) return obstacle;
        const bool needsPlace = primitive.NeedsPlace || !scene.transport.cameraUnwarped;
        return needsPlace && scene.camera.hasParallelRays()
                   ? "parallel rays, or detectors, have no one position to aim at"
                   : "";
    };
    return std::visit(own, settings.primitive);
}

/// Why there is one camera path for each sample, whatever the image's size; empty where there may be more.
std::string cameraPathsObstacle(const PhotonPlan& plan, const PhotonSettings& settings) {
    if (!plan.guidance.on) return plan.guidance.reason;
    if (!plan.splats()) return "nothing is splatted";
    if (settings.policy.sampling.published) return "the preset has one";
    if (plan.glossyPaths.on) return "paths on from glossy surfaces take long";
    const bool often = std::visit([](const auto& p) { return p.SplatsOften; }, settings.primitive);
    return often ? "" : "slices take long to draw";
}

uint32_t cameraPathsOf(const Scene& scene, const PhotonSettings& settings) {
    const uint64_t pixels = uint64_t(scene.camera.resolution.x) * uint64_t(scene.camera.resolution.y);
    const uint64_t paths = std::min<uint64_t>(tuning::CameraPaths, settings.volumePhotonCount);
    return uint32_t(std::clamp<uint64_t>(paths / pixels, 1, tuning::MostCameraPaths));
}

std::string connectionObstacle(const PhotonPlan& plan, const PhotonSettings& settings, const EffectPlan& facts) {
    if (!plan.guidance.on) return plan.guidance.reason;
    if (facts.surfacesOutOfTime) return OutOfTime;
    if (!settings.includeSurfaces || !facts.surfaceScattering) return "no surface is gathered";
    if (!plan.straightRays) return "a thin lens, or different speeds of light";
    return settings.policy.connectsSurfaces() ? "" : "the preset or surface_connections leaves surfaces to photons";
}

} // namespace

PhotonPlan PhotonPlan::of(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts) {
    PhotonPlan plan;
    plan.highestSpeed = facts.highestSpeed;
    plan.lateEmitters = facts.late;
    plan.mediaOutOfTime = facts.mediaOutOfTime;
    plan.darkFrames = facts.darkFrames;
    plan.oneSpeed = !facts.speedsDiffer;
    plan.homogeneous = facts.heterogeneousMedia.empty();
    plan.straightRays = scene.camera.hasSinglePosition() && plan.oneSpeed;
    const std::string obstacle = guidanceObstacle(scene, settings, facts);
    plan.guidance = {obstacle.empty(), obstacle.empty() ? "the scene asks for DARTS" : obstacle};
    plan.edaTable = tablesOf(scene, settings, facts, plan.guidance);
    plan.chooseSensorPaths(scene, settings, facts);
    plan.chooseGuidance(scene, settings, facts);
    plan.chooseStores(scene, settings, facts);
    return plan;
}

void PhotonPlan::chooseSensorPaths(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts) {
    const bool any = anyGlossyOnly(scene);
    // Time without camera segments ends at the first surface that is no mirror.
    const bool unwarped = scene.transport.cameraUnwarped;
    glossyPaths.on = guidance.on && any && !facts.surfacesOutOfTime && settings.includeSurfaces && !unwarped &&
                     settings.policy.followsGlossy();
    glossyPaths.reason = !any             ? "no surface is glossy without being diffuse"
                         : glossyPaths.on ? "sensor paths go on at surfaces that are glossy only, as at mirrors"
                         : !settings.includeSurfaces ? "include_surfaces is false"
                         : facts.surfacesOutOfTime   ? OutOfTime
                         : unwarped ? "camera_unwarped: time stops at glossy surfaces, which are left to photons"
                                    : "the preset or glossy_sensor_paths leaves glossy surfaces to photons";
    folds = facts.specularSensorPaths || glossyPaths.on;
    looksAgain = settings.includeSurfaces;
}

void PhotonPlan::chooseGuidance(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts) {
    const TimeGate& gate = scene.transport.gate;
    const transport::Policy& policy = settings.policy;
    const bool straight = !folds && oneSpeed;
    directView =
        policy.directView == transport::DirectView::Auto ? straight : policy.directView == transport::DirectView::On;
    const bool pointLike = scene.transport.cameraUnwarped || scene.camera.aperture() == 0.0f;
    const bool exact = guidance.on && directView && straight && pointLike;
    const bool manyFrames = std::visit([](const auto& p) { return p.ManyFrames; }, settings.primitive);
    framesOneByOne.on = exact && gate.frames > 1 && policy.aimsAtSingleFrames() && !manyFrames;
    framesOneByOne.reason = manyFrames          ? "a sliced primitive shows in many frames"
                            : framesOneByOne.on ? "each light path aims at one frame"
                                                : "light paths aim at the whole sequence as one gate";
    drawsByResponse = exact && !scene.transport.response.empty();
    meetsDeltaGate = exact && gate.delta && policy.sampling.elliptical;
    boundsAlone.on = guidance.on && policy.followsBodies() && !facts.surfaceScattering && !gate.delta &&
                     !scene.transport.cameraUnwarped && transport::gateInBodies(scene).collisions > tuning::WidestGate;
    boundsAlone.reason = boundsAlone.on
                             ? "a gate so wide that most light which leaves the bodies is in time"
                             : "only for long gates over bodies that are seen and lit from outside, without surfaces";
    const bool atVertices = std::visit([](const auto& p) { return p.AtVertices; }, settings.primitive);
    ordinaryPhotons.on = atVertices && (boundsAlone.on || !directView ||
                                        (policy.directView == transport::DirectView::Auto &&
                                         !policy.sampling.published && !meetsDeltaGate && !drawsByResponse));
    ordinaryPhotons.reason = !atVertices ? "no points are stored: there are no control vertices"
                             : !directView
                                 ? "mirrors, refraction or different speeds: control vertices alone are not complete"
                             : boundsAlone.on     ? "bounds in time alone: there are no control vertices"
                             : ordinaryPhotons.on ? "by the balance heuristic, where the gate lets as many of them pass"
                             : meetsDeltaGate     ? "delta gate: none of them arrives on it"
                             : drawsByResponse    ? "control vertices are drawn by the sensor's response"
                                                  : "the preset or direct_view: control vertices alone are complete";
    const std::string obstacle = connectionObstacle(*this, settings, facts);
    connections = {obstacle.empty(), obstacle.empty()
                                         ? "light paths connect to the surface points that the camera sees in time"
                                         : obstacle};
}

void PhotonPlan::chooseStores(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts) {
    const bool oneTime = oneSpeed || scene.transport.cameraUnwarped;
    primitiveSplats = std::visit([&](const auto& p) { return p.splats(straightRays, oneTime); }, settings.primitive);
    const bool atVertices = std::visit([](const auto& p) { return p.AtVertices; }, settings.primitive);
    volume.on = facts.mediumScattering && (homogeneous || atVertices);
    const std::string obstacle = cameraPathsObstacle(*this, settings);
    cameraPaths = obstacle.empty() ? cameraPathsOf(scene, settings) : 1;
    cameraPathsReason = !obstacle.empty()  ? obstacle
                        : cameraPaths == 1 ? "the image has many pixels, or passes have few light paths"
                                           : std::to_string(cameraPaths) +
                                                 " for each sample of a pixel: the image is small, and they take "
                                                 "little time beside guided light paths";
    volume.reason = !facts.mediumScattering ? facts.noScattering() + ": no volume photon is stored or gathered"
                    : !volume.on            ? facts.heterogeneity()
                    : !settings.primitiveReason.empty()
                        ? settings.primitiveReason
                        : std::visit([](const auto& p) { return std::string(p.Reason); }, settings.primitive);
    const bool delta = scene.transport.gate.delta;
    const std::string kernel = "delta gate: a box about it that narrows with the radius";
    temporalKernel = {delta, !delta                         ? "the gate has a width, or none"
                             : meetsDeltaGate && atVertices ? kernel + "; control vertices lie on the gate itself"
                                                            : kernel};
    surfacePhotons.on = settings.includeSurfaces && facts.surfaceScattering && !facts.surfacesOutOfTime;
    surfacePhotons.reason = !settings.includeSurfaces ? "include_surfaces is false"
                            : facts.surfacesOutOfTime ? OutOfTime
                            : !surfacePhotons.on      ? "no surface has a smooth lobe"
                            : connections.on          ? "for what connections cannot bring: light by way of mirrors or "
                                                        "refraction or of a single direction, and to glossy surfaces"
                                                      : "smooth surfaces are gathered";
    exactCulling.on = facts.timeResolved && straightRays && !folds;
    exactCulling.reason = !facts.timeResolved ? "steady state: every photon counts"
                          : exactCulling.on
                              ? "direct view: photons that arrive outside the gate are not stored"
                              : "sensor paths can fold, change speed or start at many points: photons are tested when "
                                "gathered";
}

void PhotonPlan::describeVolume(const PhotonSettings& settings, EffectPlan& plan) const {
    const std::vector<std::string> type{"integrator.volume_photon_type"};
    forEachPrimitive(settings.primitive, [&](const auto& p) {
        using Primitive = std::decay_t<decltype(p)>;
        const bool used = std::holds_alternative<Primitive>(settings.primitive);
        const std::string other = std::visit([](const auto& q) { return std::string(q.Effect); }, settings.primitive);
        plan.describe(p.Effect, used && volume.on, used ? volume.reason : "volumes store " + other, type, {p.Stored});
    });
    if (volume.on && !settings.radiusReason.empty())
        plan.describe("default radius", true, settings.radiusReason, {"integrator.volume_gather_radius"});
    describeSplatting(plan);
}

void PhotonPlan::describeSplatting(EffectPlan& plan) const {
    const bool splatted = volume.on && splats(), gathered = volume.on && (!splats() || folds);
    plan.describe("splatting", splatted,
                  !volume.on ? volume.reason
                  : splatted ? "straight rays: every record visits the pixels that see it"
                             : "rays are not straight, or not of one speed",
                  {"camera"}, {"splatted records"});
    plan.describe("gathering", gathered,
                  !volume.on ? volume.reason
                  : gathered ? std::string(splats() ? "folded rays" : "rays") + " look for the records that they meet"
                             : "all rays are straight: records are splatted",
                  {"camera"}, {"gathered records"});
    plan.describe("more camera paths", cameraPaths > 1, cameraPathsReason, {"camera"});
}

void PhotonPlan::describeGuidance(const Scene& scene, const PhotonSettings& settings, EffectPlan& plan) const {
    const std::vector<std::string> darts{"integrator.darts"};
    const bool atVertices = std::visit([](const auto& p) { return p.AtVertices; }, settings.primitive);
    plan.describe("guided light paths", guidance.on, guidance.reason, darts,
                  atVertices ? std::vector<std::string>{"control vertices"} : std::vector<std::string>{});
    plan.describe("EDA table", edaTable.on, edaTable.reason, darts, {"direction tables"});
    plan.describe("surface connections", connections.on, connections.reason, darts, {"surface connections"});
    plan.describe("sharing", connections.on,
                  connections.on ? "what a surface point receives is shared among neighbouring pixels"
                                 : connections.reason,
                  darts, {"surface connections"});
    const bool glossy = guidance.on && glossyPaths.on;
    plan.describe("glossy sensor paths", glossy, guidance.on ? glossyPaths.reason : guidance.reason,
                  bsdfUses(scene, [](const Bsdf& bsdf) { return isGlossyOnly(bsdf); }).causes(),
                  {"glossy sensor reflections"});
    if (!guidance.on) return;
    plan.describe("bounds in time alone", boundsAlone.on, boundsAlone.reason, {"integrator.darts"});
    if (!scene.transport.cameraUnwarped && !boundsAlone.on)
        transport::WaysOut::plan(scene, settings.policy, false, plan);
    const size_t bodies = settings.policy.followsBodies() ? transport::spheresAboutBodies(scene).size() : 0;
    plan.describe("light towards bodies", bodies > 0,
                  bodies > 0 ? "a fifth of what lamps outside fog send goes towards " + std::to_string(bodies) +
                                   (bodies > 1 ? " bodies" : " body") + " of it"
                             : "no body of fog in what does not scatter, or left alone",
                  darts);
    if (scene.transport.gate.frames > 1)
        plan.describe("frames one by one", framesOneByOne.on, framesOneByOne.reason, darts, {"frames aimed at"});
    plan.describe("photons beside control vertices", ordinaryPhotons.on, ordinaryPhotons.reason, darts);
}

void PhotonPlan::describe(const Scene& scene, const PhotonSettings& settings, EffectPlan& plan) const {
    transport::countSteps(plan);
    describeVolume(settings, plan);
    plan.describe("temporal kernel", temporalKernel.on, temporalKernel.reason, {"integrator.delta_time_gate"});
    plan.describe("surface photons", surfacePhotons.on, surfacePhotons.reason, lobeUses(scene, lobe::Smooth).causes(),
                  {"stored surface photons", "photons gathered on surfaces"});
    describeGuidance(scene, settings, plan);
    plan.describe("exact arrival culling", exactCulling.on, exactCulling.reason, {"integrator"});
}

} // namespace tungsten::photon
