#include "path/PathPlan.h"

#include "path/PathTarget.h"
#include "path/Tuning.h"
#include "path/techniques/LightCaches.h"
#include "path/techniques/RefractiveConnections.h"

#include "transport/EscapeModels.h"
#include "transport/GuidancePlan.h"
#include "transport/SamplingSummary.h"
#include "transport/StepCounters.h"

#include "tungsten/integrator/Names.h"
#include "tungsten/integrator/SceneElements.h"

namespace tungsten::path {

namespace {

/// No vertex can be connected to an emitter.
bool noConnection(const Scene& scene, const PathSettings& settings, const SceneFacts& facts) {
    return settings.policy.followsBodies() && !facts.surfaceScattering && !scene.transport.gate.delta &&
           transport::isSealed(scene);
}

Decision guidanceOf(const Scene& scene, const PathSettings& settings, const SceneFacts& facts) {
    const std::string obstacle = transport::guidanceObstacle(scene, settings.policy, facts);
    if (!obstacle.empty()) return {false, obstacle};
    const bool on = settings.lightSampling && settings.volumeLightSampling && !noConnection(scene, settings, facts);
    const char* preset = settings.policy.sampling.published ? "published DARTS sampling of scattering media"
                                                            : "DARTS sampling of scattering media";
    return {on, on ? preset
                   : "paths connect to no emitter: light sampling is off, or all that scatters lies behind walls that "
                     "refract"};
}

Decision refractedOf(const Scene& scene, const PathSettings& settings, const SceneFacts& facts) {
    const bool on = facts.timeResolved && facts.mediumScattering && facts.heterogeneousMedia.empty() &&
                    settings.lightSampling && settings.volumeLightSampling && noConnection(scene, settings, facts) &&
                    RefractiveConnections::helpsWith(scene);
    return {on, on ? "paths aim from inside bodies at points of lights that refraction brings them to in time"
                   : "no gate, not all that scatters is sealed by walls that refract, or no light with a simple "
                     "surface is outside"};
}

/// What a pilot of camera paths may choose.
Decision adaptiveOf(const Scene& scene, bool wanted, const std::string& does) {
    const bool on = wanted && !scene.camera.detectors();
    return {
        on,
        on ? does
           : "the preset, its own option, detectors, nothing to see, or guided paths without plain ones beside them"};
}

/// Some light can be met.
bool shines(const SceneFacts& facts) {
    return facts.surfaceEmission || facts.environment;
}

/// Plain paths may be taken alone.
bool mayBePlain(const PathSettings& settings, const PathPlan& plan) {
    return (plan.balance.on || !plan.guidance.on) && settings.policy.plainShare.value_or(1.0f) == 1.0f;
}

Decision firstScatteringOf(const Scene& scene, const SceneFacts& facts, bool lasers) {
    const bool on = !lasers || (scene.camera.detectors() && !facts.specularCameraSubpaths);
    return {on, on ? "no light of a single direction, or places of detectors are connected to it"
                   : "camera paths meet it with probability zero where it is scattered for the first time"};
}

Decision lightVerticesOf(const PathPlan& plan, const Scene& scene, const PathSettings& settings,
                         const SceneFacts& facts) {
    if (!plan.guidance.on) return plan.guidance;
    const bool on = settings.policy.connectsSurfaces() && facts.surfaceScattering && !facts.speedsDiffer &&
                    LightCaches::helpWith(scene);
    return {on, on ? "paths connect to surface points that light reaches first"
                   : "the preset or surface_connections, no smooth surface, several speeds of light, or too many "
                     "emitters or none that shines in more than one direction"};
}

} // namespace

PathPlan PathPlan::of(const Scene& scene, const PathSettings& settings, const SceneFacts& facts) {
    PathPlan plan;
    plan.timeResolved = facts.timeResolved;
    plan.media = !scene.media.empty() || facts.everything;
    plan.indexMatched = facts.forwardBoundaries;
    plan.forwardBoundaries = facts.forwardBoundaries || facts.everything;
    plan.lasers = std::any_of(scene.emitters.begin(), scene.emitters.end(),
                              [](const Emitter& emitter) { return emitter.isDelta(); });
    plan.firstScatteringInView = firstScatteringOf(scene, facts, plan.lasers);
    plan.detectorLight = transport::detectorLightOf(scene, facts, true);
    plan.guidance = guidanceOf(scene, settings, facts);
    plan.roulette = {settings.russianRoulette, settings.russianRoulette ? "enable_rr, or its default in steady state"
                                                                        : "off by default in time-resolved renders"};
    plan.edaTable = transport::tablesOf(scene, settings.policy, darts::Mode::Path, facts, plan.guidance.on);
    plan.balance =
        transport::balanceOf(scene, settings.policy, darts::Mode::Path, plan.guidance, !scene.transport.gate.delta);
    plan.allocation =
        adaptiveOf(scene, settings.policy.allocatesSamples(), "more samples where paths vary more for what they cost");
    plan.weightWindows = adaptiveOf(scene, settings.policy.usesWeightWindows() && mayBePlain(settings, plan),
                                    "plain paths alone split and end by what those of a pilot found");
    plan.lightsInView = adaptiveOf(
        scene, settings.policy.expectsLightsInView() && mayBePlain(settings, plan) && plan.media && shines(facts),
        "plain paths alone see lights through media in expectation");
    plan.refracted = refractedOf(scene, settings, facts);
    plan.lightVertices = lightVerticesOf(plan, scene, settings, facts);
    plan.reflectedLight.on = plan.lightVertices.on && LightCaches::reflectedIn(scene);
    plan.reflectedLight.reason = !plan.lightVertices.on   ? plan.lightVertices.reason
                                 : plan.reflectedLight.on ? "paths connect to where glossy surfaces throw light"
                                                          : "no glossy surface";
    return plan;
}

SamplingSummary PathPlan::summary(const Scene& scene, const PathSettings& settings, const SceneFacts& facts) const {
    const transport::Policy& policy = settings.policy;
    SamplingSummary said;
    said.paths = transport::describeStrategies("camera paths", guidance, balance, policy.plainShare);
    if (balance.on && scene.transport.gate.frames > 1) said.paths += "; guided ones aim at windows of the sequence";
    if (allocation.on) said.paths += "; " + allocation.reason;
    said.vertices = guidance.on ? transport::describeVertices(scene, policy, darts::Mode::Path, facts, true)
                                : transport::PlainVertices;
    const bool connects = settings.lightSampling || settings.volumeLightSampling;
    said.ends = transport::describeEnds({{guidance.on && policy.sampling.elliptical, "control vertices"},
                                         {connects, "connections to lights"},
                                         {shines(facts), "lights that are met"},
                                         {lightVertices.on, lightVertices.reason},
                                         {reflectedLight.on, reflectedLight.reason},
                                         {refracted.on, refracted.reason},
                                         {detectorLight.on, detectorLight.reason}});
    return said;
}

void PathPlan::describe(const Scene& scene, const PathSettings& settings, const SceneFacts& facts,
                        Features& features) const {
    const auto add = [&](const std::string& name, const Decision& choice, const std::vector<std::string>& causes,
                         const std::vector<std::string>& counters = {}) {
        features.describe(name, choice.on, choice.reason, causes, counters);
    };
    countArrivals(features);
    features.sampling = summary(scene, settings, facts);
    if (!firstScatteringInView.on) features.limit("light of a single direction in view", firstScatteringInView.reason);
    if (settings.missed)
        features.limit("light of points by mirrors and refraction",
                       settings.missed->description() + " is met with probability zero");
    if (scene.camera.detectors()) add("lights at detectors", detectorLight, {"camera"}, {counter::ArrivalsAtDetectors});
    if (!guidance.on) add("Russian roulette", roulette, {"integrator.enable_rr"});
    add("guided paths", guidance, {"integrator.darts"}, {counter::ControlVertices});
    add("plain paths beside them", balance, {"integrator.darts"}, {counter::PilotPaths});
    add("adaptive samples", allocation, {"integrator.darts"}, {"pilot samples"});
    add("weight windows", weightWindows, {"integrator.darts"}, {counter::WindowPilotPaths});
    add("lights in view in expectation", lightsInView, {"integrator.darts"}, {counter::LightsInView});
    add("refractive connections", refracted, {"integrator.darts"}, {counter::RefractiveConnections});
    add("EDA table", edaTable, {"integrator.darts"}, {counter::DirectionTables});
    if (guidance.on) transport::EscapeModels::plan(scene, settings.policy, features);
    add("light vertices", lightVertices, {"integrator.darts"}, {counter::LightVertexConnections, counter::LightPaths});
    add("glossy light vertices", reflectedLight,
        elementsWithLobe(scene, lobe::GlossyReflection | lobe::SpecularReflection).paths(),
        {counter::GlossyLightVertexConnections});
}

void countArrivals(Features& features) {
    transport::countSteps(features);
    features.count(feature::TimeOfFlight, {counter::ArrivalsInGate});
    features.count(feature::Frames, {counter::ArrivalsInLaterFrames});
    features.count(feature::TemporalResponse, {counter::ArrivalsByResponse});
}

std::string deltaGateProblem(const Scene& scene, const PathSettings& settings, const SceneFacts& facts) {
    if (!PathPlan::of(scene, settings, facts).guidance.on || !settings.policy.sampling.elliptical)
        return "plain paths meet a delta gate with probability zero; give the gate a width, or set \"darts\": \"best\"";
    if (facts.surfaceScattering || facts.surfaceEmission || facts.speedsDiffer)
        return "light from diffuse, glossy or emitting surfaces, or through regions of different speeds, meets a delta "
               "gate with probability zero; give the gate a width";
    return {};
}

} // namespace tungsten::path
