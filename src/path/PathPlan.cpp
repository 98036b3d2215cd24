#include "path/PathPlan.h"

#include "path/PathTarget.h"
#include "path/Tuning.h"
#include "path/techniques/LightPaths.h"
#include "path/techniques/RefractedLight.h"

#include "transport/DetectorLight.h"
#include "transport/GuidancePlan.h"
#include "transport/SamplingSummary.h"
#include "transport/StepCounters.h"
#include "transport/WaysOut.h"

#include "tungsten/integrator/SceneElements.h"

namespace tungsten::path {

namespace {

/// No vertex can be connected to an emitter.
bool noConnection(const Scene& scene, const PathSettings& settings, const EffectPlan& facts) {
    return settings.policy.followsBodies() && !facts.surfaceScattering && !scene.transport.gate.delta &&
           transport::isSealed(scene);
}

std::string guidanceObstacle(const Scene& scene, const PathSettings& settings, const EffectPlan& facts) {
    const std::string obstacle = transport::guidanceObstacle(settings.policy, facts);
    if (!obstacle.empty()) return obstacle;
    if (!settings.lightSampling || !settings.volumeLightSampling) return "paths shall not connect to emitters";
    if (noConnection(scene, settings, facts))
        return "all that scatters lies behind walls that refract: no connection is complete";
    return {};
}

Choice refractedOf(const Scene& scene, const PathSettings& settings, const EffectPlan& facts) {
    if (!facts.timeResolved || !facts.mediumScattering || !facts.heterogeneousMedia.empty() ||
        !settings.lightSampling || !settings.volumeLightSampling || !noConnection(scene, settings, facts))
        return {false, "not all that scatters is sealed by walls that refract, in a time-resolved render"};
    if (!RefractedLight::helpsWith(scene))
        return {false, "no light with a simple surface is outside the bodies, or many are"};
    return {true, "paths aim from inside bodies at points of lights that refraction brings them to in time"};
}

Choice firstScatteringOf(const Scene& scene, const EffectPlan& facts, bool lasers) {
    if (!lasers) return {true, "every light shines in more than one direction"};
    if (!scene.camera.detectors())
        return {false, "camera paths meet it with probability zero where it is scattered for the first time"};
    if (facts.specularSensorPaths)
        return {false, "mirrors and refraction show where it is scattered for the first time with probability zero"};
    return {true, "places of detectors are connected to it"};
}

std::string lightVertexObstacle(const PathPlan& plan, const Scene& scene, const PathSettings& settings,
                                const EffectPlan& facts) {
    if (!plan.guidance.on) return "paths are not guided";
    if (!settings.policy.connectsSurfaces()) return "not in the published method, or surface_connections is false";
    if (!facts.surfaceScattering) return "no surface has a smooth lobe";
    if (facts.speedsDiffer) return "light does not travel at one speed";
    if (!LightPaths::helpWith(scene)) return "too many emitters, or none that shines in more than one direction";
    return {};
}

Choice balanceOf(const Scene& scene, const PathSettings& settings, const Choice& guidance) {
    if (!guidance.on) return {false, "paths are not guided"};
    if (scene.transport.gate.delta) return {false, "no plain path meets a gate of width 0"};
    if (!transport::haveDensities(scene, settings.policy, darts::Mode::Path))
        return {false, "the published method, or switches that leave densities unknown"};
    return {true, "plain paths beside guided ones, each weighed by how densely both find what it has found"};
}

} // namespace

PathPlan PathPlan::of(const Scene& scene, const PathSettings& settings, const EffectPlan& facts) {
    PathPlan plan;
    plan.timeResolved = facts.timeResolved;
    plan.media = !scene.media.empty() || facts.everything;
    plan.indexMatched = facts.forwardBoundaries;
    plan.forwardBoundaries = facts.forwardBoundaries || facts.everything;
    plan.lasers = std::any_of(scene.emitters.begin(), scene.emitters.end(),
                              [](const Emitter& emitter) { return emitter.isDelta(); });
    plan.firstScatteringInView = firstScatteringOf(scene, facts, plan.lasers);
    const bool reaches = transport::DetectorLight::mayReach(scene, facts);
    plan.detectorLight = {reaches, reaches ? "places of detectors are connected to lights that no ray meets"
                                           : "no detector, or rays meet every light"};
    const std::string obstacle = guidanceObstacle(scene, settings, facts);
    const bool published = settings.policy.sampling.published;
    plan.guidance = {obstacle.empty(), !obstacle.empty() ? obstacle
                                                         : std::string(published ? "published " : "") +
                                                               "DARTS sampling of scattering media"};
    plan.roulette = {settings.russianRoulette, settings.russianRoulette ? "enable_rr, or its default in steady state"
                                                                        : "off by default in time-resolved renders"};
    plan.edaTable = transport::tablesOf(scene, settings.policy, darts::Mode::Path, facts, plan.guidance.on);
    plan.balance = balanceOf(scene, settings, plan.guidance);
    plan.refracted = refractedOf(scene, settings, facts);
    plan.chooseLightPaths(scene, settings, facts);
    return plan;
}

void PathPlan::chooseLightPaths(const Scene& scene, const PathSettings& settings, const EffectPlan& facts) {
    const std::string obstacle = lightVertexObstacle(*this, scene, settings, facts);
    lightVertices = {obstacle.empty(),
                     obstacle.empty() ? "paths connect to surface points that light reaches first" : obstacle};
    reflectedLight.on = lightVertices.on && LightPaths::reflectedIn(scene);
    reflectedLight.reason = !lightVertices.on   ? obstacle
                            : reflectedLight.on ? "paths connect to where glossy surfaces throw light"
                                                : "no glossy surface";
}

SamplingSummary PathPlan::summary(const Scene& scene, const PathSettings& settings, const EffectPlan& facts) const {
    const transport::Policy& policy = settings.policy;
    SamplingSummary said;
    said.paths = transport::describeStrategies("camera paths", guidance, balance, policy.plainShare);
    if (balance.on && scene.transport.gate.frames > 1) said.paths += "; guided ones aim at windows of the sequence";
    said.vertices = guidance.on ? transport::describeVertices(scene, policy, darts::Mode::Path, facts, true)
                                : transport::PlainVertices;
    const bool connects = settings.lightSampling || settings.volumeLightSampling;
    said.ends = transport::describeEnds({{guidance.on && policy.sampling.elliptical, "control vertices"},
                                         {connects, "connections to lights"},
                                         {facts.surfaceEmission || facts.environment, "lights that are met"},
                                         {lightVertices.on, lightVertices.reason},
                                         {reflectedLight.on, reflectedLight.reason},
                                         {refracted.on, refracted.reason},
                                         {detectorLight.on, detectorLight.reason}});
    return said;
}

void PathPlan::describe(const Scene& scene, const PathSettings& settings, EffectPlan& plan) const {
    const auto add = [&](const std::string& name, const Choice& choice, const std::vector<std::string>& causes,
                         const std::vector<std::string>& counters = {}) {
        plan.describe(name, choice.on, choice.reason, causes, counters);
    };
    countArrivals(plan);
    plan.sampling = summary(scene, settings, plan);
    if (!firstScatteringInView.on) plan.lack("light of a single direction in view", firstScatteringInView.reason);
    if (settings.missed)
        plan.lack("light of points by mirrors and refraction",
                  settings.missed->description() + " is met with probability zero");
    if (scene.camera.detectors())
        add("lights at detectors", detectorLight, {"camera"}, {"arrivals from lights at detectors"});
    if (!guidance.on) add("Russian roulette", roulette, {"integrator.enable_rr"});
    add("guided paths", guidance, {"integrator.darts"}, {"control vertices"});
    add("plain paths beside them", balance, {"integrator.darts"}, {"pilot paths"});
    add("light through walls", refracted, {"integrator.darts"}, {"ways through walls"});
    add("EDA table", edaTable, {"integrator.darts"}, {"direction tables"});
    if (guidance.on) transport::WaysOut::plan(scene, settings.policy, true, plan);
    add("light vertices", lightVertices, {"integrator.darts"}, {"light vertex connections", "light paths"});
    add("reflected light", reflectedLight, lobeUses(scene, lobe::GlossyReflection | lobe::SpecularReflection).causes(),
        {"reflected light connections"});
}

void countArrivals(EffectPlan& plan) {
    transport::countSteps(plan);
    plan.count("time of flight", {"arrivals inside the gate"});
    plan.count("frames", {"arrivals in later frames"});
    plan.count("temporal response", {"arrivals weighed by the response"});
}

std::string deltaGateProblem(const Scene& scene, const PathSettings& settings, const EffectPlan& facts) {
    if (!PathPlan::of(scene, settings, facts).guidance.on || !settings.policy.sampling.elliptical)
        return "plain paths meet a delta gate with probability zero; give the gate a width, or set \"darts\": \"best\"";
    if (facts.surfaceScattering || facts.surfaceEmission)
        return "light from diffuse, glossy or emitting surfaces meets a delta gate with probability zero; give the "
               "gate a width";
    if (facts.speedsDiffer)
        return "connections through regions of different speeds meet a delta gate with probability zero; give the "
               "gate a width";
    return {};
}

} // namespace tungsten::path
