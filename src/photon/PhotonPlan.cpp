#include "photon/PhotonPlan.h"

#include "photon/Tuning.h"
#include "photon/view/SensorPath.h"

#include "transport/Body.h"
#include "transport/DetectorLight.h"
#include "transport/GuidancePlan.h"

namespace tungsten::photon {

namespace {

/// What a plan is made from.
struct Given {
    const Scene& scene;
    const PhotonSettings& settings;
    const EffectPlan& facts;

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

// Each of these says what is done, and why: the first reason that holds decides.

Choice guidanceOf(const Given& given) {
    const EffectPlan& facts = given.facts;
    std::string obstacle = transport::guidanceObstacle(given.policy(), facts);
    if (obstacle.empty())
        obstacle =
            given.ofPrimitive([&](const auto& p) { return p.guidanceObstacle(given.scene, facts.speedsDiffer); });
    if (!obstacle.empty()) return {false, obstacle};
    const bool needsPlace = given.ofPrimitive([](const auto& p) { return p.NeedsPlace; }) || !given.unwarped();
    if (needsPlace && given.scene.camera.hasParallelRays())
        return {false, "parallel rays, or detectors, have no one position to aim at"};
    return {true, "the scene asks for DARTS"};
}

Choice surfacesOf(const Given& given) {
    if (!given.settings.includeSurfaces) return {false, "include_surfaces is false"};
    if (given.facts.surfacesOutOfTime) return {false, "what surfaces show arrives after the sensor has closed"};
    if (!given.facts.surfaceScattering) return {false, "no surface has a smooth lobe"};
    return {true, "smooth surfaces are gathered"};
}

Choice glossyPathsOf(const Given& given, const PhotonPlan& plan) {
    if (!plan.guidance.on) return plan.guidance;
    if (!anyGlossyOnly(given.scene)) return {false, "no surface is glossy without being diffuse"};
    if (const Choice surfaces = surfacesOf(given); !surfaces.on) return surfaces;
    // Time without camera segments ends at the first surface that is no mirror.
    if (given.unwarped()) return {false, "camera_unwarped: time stops at glossy surfaces, which are left to photons"};
    if (!given.policy().followsGlossy())
        return {false, "the preset or glossy_sensor_paths leaves glossy surfaces to photons"};
    return {true, "sensor paths go on at surfaces that are glossy only, as at mirrors"};
}

Choice framesOneByOneOf(const Given& given, bool exact) {
    if (given.ofPrimitive([](const auto& p) { return p.ManyFrames; }))
        return {false, "a sliced primitive shows in many frames"};
    const bool on = exact && given.scene.transport.gate.frames > 1 && given.policy().aimsAtSingleFrames();
    return {on, on ? "each light path aims at one frame" : "light paths aim at the whole sequence as one gate"};
}

Choice sideBySideOf(const Given& given, const PhotonPlan& plan) {
    if (!plan.guidance.on) return plan.guidance;
    if (given.policy().plainShare == 0.0f) return {false, "plain_share is 0"};
    if (plan.framesOneByOne.on) return {false, "frames one by one"};
    if (given.policy().directView == transport::DirectView::On)
        return {false, "direct_view asks for control vertices alone"};
    if (plan.meetsDeltaGate) return {false, "delta gate: control vertices lie on it, where no plain photon arrives"};
    if (!transport::haveDensities(given.scene, given.policy(), darts::Mode::Photon))
        return {false, "the published method, or switches that leave densities unknown"};
    return {true, "plain and guided light paths, weighed by how densely both leave each record"};
}

Choice ordinaryPhotonsOf(const Given& given, const PhotonPlan& plan) {
    if (!given.atVertices()) return {false, "no points are stored: there are no control vertices"};
    if (plan.sideBySide.on) return {true, "they share with plain light paths, too"};
    if (!plan.directView)
        return {true, "mirrors, refraction or different speeds: control vertices alone are not complete"};
    if (plan.meetsDeltaGate) return {false, "delta gate: none of them arrives on it"};
    if (plan.drawsByResponse) return {false, "control vertices are drawn by the sensor's response"};
    if (given.policy().directView != transport::DirectView::Auto || given.policy().sampling.published)
        return {false, "the preset or direct_view: control vertices alone are complete"};
    return {true, "by the balance heuristic, where the gate lets as many of them pass"};
}

Choice connectionsOf(const Given& given, const PhotonPlan& plan) {
    if (!plan.guidance.on) return plan.guidance;
    if (const Choice surfaces = surfacesOf(given); !surfaces.on) return surfaces;
    if (!plan.straightRays) return {false, "a thin lens, or different speeds of light"};
    if (!given.policy().connectsSurfaces())
        return {false, "the preset or surface_connections leaves surfaces to photons"};
    return {true, "light paths connect to the surface points that the camera sees in time"};
}

Choice volumeOf(const Given& given, const PhotonPlan& plan) {
    if (!given.facts.mediumScattering)
        return {false, given.facts.noScattering() + ": no volume photon is stored or gathered"};
    if (!plan.homogeneous && !given.atVertices()) return {false, given.facts.heterogeneity()};
    if (!given.settings.primitiveReason.empty()) return {true, given.settings.primitiveReason};
    return {true, given.ofPrimitive([](const auto& p) { return std::string(p.Reason); })};
}

Choice temporalKernelOf(const Given& given, const PhotonPlan& plan) {
    if (!given.delta()) return {false, "the gate has a width, or none"};
    const std::string kernel = "delta gate: a box about it that narrows with the radius";
    return {true,
            plan.meetsDeltaGate && given.atVertices() ? kernel + "; control vertices lie on the gate itself" : kernel};
}

Choice surfacePhotonsOf(const Given& given, const PhotonPlan& plan) {
    Choice surfaces = surfacesOf(given);
    if (surfaces.on && plan.connections.on)
        surfaces.reason = "for what connections cannot bring: light by way of mirrors or refraction or of a single "
                          "direction, and to glossy surfaces";
    return surfaces;
}

Choice detectorLightOf(const Given& given) {
    if (!given.settings.includeSurfaces) return {false, "include_surfaces is false"};
    const bool on = transport::DetectorLight::mayReach(given.scene, given.facts);
    return {on, on ? "places of detectors are connected to lights that no ray meets"
                   : "no detector, or rays meet every light"};
}

Choice exactCullingOf(const Given& given, const PhotonPlan& plan) {
    if (!given.facts.timeResolved) return {false, "steady state: every photon counts"};
    if (!plan.straightRays || plan.folds)
        return {false, "sensor paths can fold, change speed or start at many points: photons are tested when gathered"};
    return {true, "direct view: photons that arrive outside the gate are not stored"};
}

/// As many camera paths for each sample of a pixel as little time is left to, at least one.
uint32_t affordedCameraPaths(const Given& given) {
    const Vec2i& resolution = given.scene.camera.resolution;
    const uint64_t pixels = uint64_t(resolution.x) * uint64_t(resolution.y);
    const uint64_t paths = std::min<uint64_t>(tuning::CameraPaths, given.settings.volumePhotonCount);
    return uint32_t(std::clamp<uint64_t>(paths / pixels, 1, tuning::MostCameraPaths));
}

Choice moreCameraPathsOf(const Given& given, const PhotonPlan& plan, uint32_t paths) {
    if (!plan.guidance.on) return plan.guidance;
    if (given.policy().sampling.published) return {false, "the preset has one"};
    if (plan.glossyPaths.on) return {false, "paths on from glossy surfaces take long"};
    if (!given.ofPrimitive([](const auto& p) { return p.SplatsOften; })) return {false, "slices take long to draw"};
    if (paths == 1) return {false, "the image has many pixels, or passes have few light paths"};
    return {true, std::to_string(paths) + " for each sample of a pixel: the image is small, and they take little time "
                                          "beside guided light paths"};
}

} // namespace

PhotonPlan PhotonPlan::of(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts) {
    const Given given{scene, settings, facts};
    PhotonPlan plan;
    plan.highestSpeed = facts.highestSpeed;
    plan.lateEmitters = facts.late;
    plan.mediaOutOfTime = facts.mediaOutOfTime;
    plan.darkFrames = facts.darkFrames;
    plan.oneSpeed = !facts.speedsDiffer;
    plan.homogeneous = facts.heterogeneousMedia.empty();
    plan.straightRays = scene.camera.hasSinglePosition() && plan.oneSpeed;
    plan.guidance = guidanceOf(given);
    plan.edaTable =
        transport::tablesOf(scene, settings.policy, darts::Mode::Photon, facts, plan.guidance.on && !given.unwarped());
    plan.glossyPaths = glossyPathsOf(given, plan);
    plan.folds = facts.specularSensorPaths || plan.glossyPaths.on;
    plan.looksAgain = settings.includeSurfaces;
    plan.chooseGuidance(scene, settings, facts);
    plan.connections = connectionsOf(given, plan);
    plan.detectorLight = detectorLightOf(given);
    plan.chooseStores(scene, settings, facts);
    return plan;
}

void PhotonPlan::chooseGuidance(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts) {
    const Given given{scene, settings, facts};
    const bool straight = !folds && oneSpeed;
    directView = settings.policy.directView == transport::DirectView::Auto
                     ? straight
                     : settings.policy.directView == transport::DirectView::On;
    const bool pointLike = given.unwarped() || scene.camera.aperture() == 0.0f;
    const bool exact = guidance.on && directView && straight && pointLike;
    framesOneByOne = framesOneByOneOf(given, exact);
    drawsByResponse = exact && !scene.transport.response.empty();
    meetsDeltaGate = exact && given.delta() && settings.policy.sampling.elliptical;
    sideBySide = sideBySideOf(given, *this);
    ordinaryPhotons = ordinaryPhotonsOf(given, *this);
}

void PhotonPlan::chooseStores(const Scene& scene, const PhotonSettings& settings, const EffectPlan& facts) {
    const Given given{scene, settings, facts};
    const bool oneTime = oneSpeed || given.unwarped();
    primitiveSplats = given.ofPrimitive([&](const auto& p) { return p.splats(straightRays, oneTime); });
    volume = volumeOf(given, *this);
    const uint32_t afforded = affordedCameraPaths(given);
    moreCameraPaths = moreCameraPathsOf(given, *this, afforded);
    cameraPaths = moreCameraPaths.on ? afforded : 1;
    temporalKernel = temporalKernelOf(given, *this);
    surfacePhotons = surfacePhotonsOf(given, *this);
    exactCulling = exactCullingOf(given, *this);
}

} // namespace tungsten::photon
