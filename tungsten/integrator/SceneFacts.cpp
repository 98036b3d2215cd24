#include "tungsten/integrator/SceneFacts.h"

#include "tungsten/integrator/BounceCuts.h"
#include "tungsten/integrator/SceneElements.h"
#include "tungsten/scene/Field.h"

#include <algorithm>
#include <set>

namespace tungsten {

namespace {

std::string describeGate(const TimeGate& gate) {
    if (gate.steadyState) return "no time gate: steady state";
    if (gate.delta) return "delta gate at time " + brief(gate.start);
    const std::string interval = "[" + brief(gate.start) + ", " + brief(gate.end()) + ")";
    return gate.frames > 1
               ? std::to_string(gate.frames) + " frames of width " + brief(gate.frameWidth) + " over " + interval
               : "one gate " + interval;
}

std::string spanOf(const TimeProfile& profile) {
    return brief(profile.times.front()) + " to " + brief(profile.times.back());
}

/// When lights shine.
void planPulses(const Scene& scene, EffectPlan& plan) {
    Uses pulses;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        if (!emitter.pulse.empty())
            pulses.add("'" + emitter.name + "' shines from " + spanOf(emitter.pulse), emitter.path + ".pulse");
    }
    const bool last = plan.timeResolved && pulses.any();
    plan.describe("pulses", last,
                  last           ? pulses.names() + " after its emission_time"
                  : pulses.any() ? "in steady state all light counts at once"
                                 : "all light is emitted in flashes",
                  pulses.causes());
    Uses delayed;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        if (emitter.emissionTime != 0.0) delayed.add(nameOf(emitter.name, i), emitter.path + ".emission_time");
    }
    const bool counts = plan.timeResolved && delayed.any();
    plan.describe("emission times", counts,
                  counts          ? "pulses that do not start at 0: " + delayed.names()
                  : delayed.any() ? "steady state: it does not matter when pulses start"
                                  : "all pulses start at 0",
                  delayed.causes());
}

void planTime(const Scene& scene, EffectPlan& plan) {
    const TimeGate& gate = scene.transport.gate;
    const TimeProfile &response = scene.transport.response, &delay = scene.transport.delay;
    plan.timeResolved = !gate.steadyState;
    plan.multipleFrames = gate.frames > 1;
    plan.describe("time of flight", plan.timeResolved, describeGate(gate), {"integrator"});
    plan.describe("frames", plan.multipleFrames,
                  plan.multipleFrames ? std::to_string(gate.frames) + " images" : "a single image",
                  {"integrator.frame_num"});
    plan.describe("delta gate", plan.timeResolved && gate.delta,
                  !plan.timeResolved ? "no time gate: steady state"
                  : gate.delta       ? "the gate has no width"
                                     : "the gate has a width",
                  {"integrator.delta_time_gate"});
    plan.describe("temporal response", !response.empty() || !delay.empty(),
                  !response.empty()
                      ? "times of arrival are weighed by " + std::to_string(response.times.size()) + " values"
                  : !delay.empty() ? "light is recorded " + spanOf(delay) + " after its arrival"
                                   : "times of arrival count alike",
                  {"integrator.temporal_response"});
    planPulses(scene, plan);
}

void planMedia(const Scene& scene, EffectPlan& plan) {
    Uses scattering, absorbing, coloured, varying, anisotropic;
    for (const int index : reachableMedia(scene)) {
        const Medium& medium = scene.media[size_t(index)];
        const std::string name = nameOf(medium.name, size_t(index));
        if (medium.scatters()) scattering.add(name, medium.path);
        if (!medium.scatters() && !medium.isVacuum()) absorbing.add(name, medium.path);
        if (!medium.isHomogeneous()) varying.add(name, medium.path);
        if (!medium.isGrey()) coloured.add(name, medium.path);
        if (medium.scatters() && !medium.phase.isIsotropic()) anisotropic.add(name, medium.path + ".phase_function");
    }
    plan.mediumScattering = scattering.any();
    plan.greyMedia = !coloured.any();
    plan.heterogeneousMedia = varying.names();
    plan.describe("medium scattering", scattering.any(),
                  scattering.any() ? "scattering media: " + scattering.names() : "no reachable medium scatters",
                  scattering.causes());
    plan.describe("absorption only", absorbing.any(),
                  absorbing.any() ? "absorbing media that scatter nothing: " + absorbing.names()
                                  : "no reachable medium absorbs without scattering",
                  absorbing.causes());
    plan.describe("coloured media", coloured.any(),
                  coloured.any() ? "coloured: " + coloured.names()
                                 : "every medium has the same coefficients in R, G and B",
                  coloured.causes());
    plan.describe("anisotropic scattering", anisotropic.any(),
                  anisotropic.any() ? "phase functions with preferred directions: " + anisotropic.names()
                                    : "every phase function is isotropic",
                  anisotropic.causes());
}

void planEmission(const Scene& scene, EffectPlan& plan) {
    Uses areas, skies;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        if (const auto surface = emitter.primitive())
            areas.add(nameOf(scene.primitives[*surface].name, *surface), emitter.path);
        else if (emitter.isInfinite())
            skies.add(nameOf(emitter.name, i), emitter.path);
    }
    plan.surfaceEmission = areas.any();
    plan.environment = skies.any();
    plan.describe("emission from surfaces", areas.any(),
                  areas.any() ? "area emitters: " + areas.names() : "no area emitter: emission is never seen",
                  areas.causes());
    plan.describe("environment", skies.any(),
                  skies.any() ? "escaping rays see " + skies.names() : "no infinite emitter: escaping rays end",
                  skies.causes());
}

void planSurfaces(const Scene& scene, EffectPlan& plan) {
    const auto describe = [&](const std::string& name, LobeMask mask, const std::string& what,
                              const std::string& otherwise) {
        const Uses uses = lobeUses(scene, mask);
        plan.describe(name, uses.any(), uses.any() ? uses.counted("surface", what) : otherwise, uses.causes());
        return uses.any();
    };
    plan.surfaceScattering = describe("surface scattering", lobe::Smooth, "with diffuse or glossy lobes",
                                      "every surface is specular, forward or black");
    plan.specularSensorPaths = describe("specular sensor paths", lobe::Specular, "with lobes that mirror or refract",
                                        "no mirror or smooth dielectric");
    describe("refraction", lobe::Transmissive, "with lobes that refract", "no surface refracts");
    plan.forwardBoundaries = describe("index-matched boundaries", lobe::Forward,
                                      "with lobes that light passes straight", "no forward or transparent surface");
}

void planSpeeds(const Scene& scene, EffectPlan& plan) {
    const Speeds speeds = reachableSpeeds(scene);
    const bool several = speeds.lowest < speeds.highest;
    plan.speedsDiffer = plan.timeResolved && several;
    plan.highestSpeed = speeds.highest;
    plan.describe("several speeds of light", plan.speedsDiffer,
                  several ? std::to_string(speeds.count) + " speeds, from " + brief(double(speeds.lowest)) + " to " +
                                brief(double(speeds.highest))
                          : "one speed everywhere: " + brief(double(speeds.highest)),
                  speeds.causes);
}

void planTextures(const Scene& scene, EffectPlan& plan) {
    const Uses varying = textureUses(scene), transparent = transparencyUses(scene);
    plan.textures = varying.any();
    plan.describe("textures", varying.any(),
                  varying.any() ? varying.counted("surface", "with parameters that vary over it")
                                : "every surface parameter is constant",
                  varying.causes());
    plan.describe("alpha", transparent.any(),
                  transparent.any() ? transparent.counted("surface", "of partial opacity")
                                    : "no surface has an opacity",
                  transparent.causes());
}

} // namespace

std::string nameOf(const std::string& name, size_t index) {
    return name.empty() ? "#" + std::to_string(index) : "'" + name + "'";
}

void EffectPlan::count(const std::string& effect, const std::vector<std::string>& counters) {
    for (Effect& described : effects)
        if (described.name == effect)
            described.counters.insert(described.counters.end(), counters.begin(), counters.end());
}

EffectPlan analyseScene(const Scene& scene, bool everything) {
    EffectPlan plan;
    plan.everything = everything;
    planTime(scene, plan);
    planMedia(scene, plan);
    planSurfaces(scene, plan);
    planSpeeds(scene, plan);
    planBounceCuts(scene, plan);
    planEmission(scene, plan);
    planTextures(scene, plan);
    return plan;
}

} // namespace tungsten
