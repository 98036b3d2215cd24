#include "tungsten/integrator/Features.h"

#include "tungsten/integrator/BounceCuts.h"
#include "tungsten/integrator/SceneElements.h"
#include "tungsten/reader/Field.h"

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
void describePulses(const Scene& scene, const SceneFacts& facts, Features& features) {
    SceneElements pulses;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        if (!emitter.pulse.empty())
            pulses.add("'" + emitter.name + "' shines from " + spanOf(emitter.pulse), emitter.path + ".pulse");
    }
    const bool last = facts.timeResolved && pulses.any();
    features.describe("pulses", last,
                      last           ? pulses.names() + " after its emission_time"
                      : pulses.any() ? "in steady state all light counts at once"
                                     : "all light is emitted in flashes",
                      pulses.paths());
    SceneElements delayed;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        if (emitter.emissionTime != 0.0) delayed.add(nameOf(emitter.name, i), emitter.path + ".emission_time");
    }
    const bool counts = facts.timeResolved && delayed.any();
    features.describe("emission times", counts,
                      counts          ? "pulses that do not start at 0: " + delayed.names()
                      : delayed.any() ? "steady state: it does not matter when pulses start"
                                      : "all pulses start at 0",
                      delayed.paths());
}

void describeTime(const Scene& scene, const SceneFacts& facts, Features& features) {
    const TimeGate& gate = scene.transport.gate;
    const TimeProfile &response = scene.transport.response, &delay = scene.transport.delay;
    features.describe(feature::TimeOfFlight, facts.timeResolved, describeGate(gate), {"integrator"});
    features.describe(feature::Frames, facts.multipleFrames,
                      facts.multipleFrames ? std::to_string(gate.frames) + " images" : "a single image",
                      {"integrator.frame_num"});
    features.describe("delta gate", facts.timeResolved && gate.delta,
                      !facts.timeResolved ? "no time gate: steady state"
                      : gate.delta        ? "the gate has no width"
                                          : "the gate has a width",
                      {"integrator.delta_time_gate"});
    features.describe(feature::TemporalResponse, !response.empty() || !delay.empty(),
                      !response.empty()
                          ? "times of arrival are weighed by " + std::to_string(response.times.size()) + " values"
                      : !delay.empty() ? "light is recorded " + spanOf(delay) + " after its arrival"
                                       : "times of arrival count alike",
                      {"integrator.temporal_response"});
    describePulses(scene, facts, features);
}

void describeMedia(const Scene& scene, Features& features) {
    SceneElements scattering, absorbing, coloured, anisotropic;
    for (const int index : reachableMedia(scene)) {
        const Medium& medium = scene.media[size_t(index)];
        const std::string name = nameOf(medium.name, size_t(index));
        if (medium.scatters()) scattering.add(name, medium.path);
        if (!medium.scatters() && !medium.isVacuum()) absorbing.add(name, medium.path);
        if (!medium.isGrey()) coloured.add(name, medium.path);
        if (medium.scatters() && !medium.phase.isIsotropic()) anisotropic.add(name, medium.path + ".phase_function");
    }
    features.describe(feature::MediumScattering, scattering.any(),
                      scattering.any() ? "scattering media: " + scattering.names() : "no reachable medium scatters",
                      scattering.paths());
    features.describe(feature::AbsorptionOnly, absorbing.any(),
                      absorbing.any() ? "absorbing media that scatter nothing: " + absorbing.names()
                                      : "no reachable medium absorbs without scattering",
                      absorbing.paths());
    features.describe(feature::ColouredMedia, coloured.any(),
                      coloured.any() ? "coloured: " + coloured.names()
                                     : "every medium has the same coefficients in R, G and B",
                      coloured.paths());
    features.describe(feature::AnisotropicScattering, anisotropic.any(),
                      anisotropic.any() ? "phase functions with preferred directions: " + anisotropic.names()
                                        : "every phase function is isotropic",
                      anisotropic.paths());
}

void describeEmission(const Scene& scene, Features& features) {
    SceneElements areas, skies;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        if (const auto surface = emitter.primitive())
            areas.add(nameOf(scene.primitives[*surface].name, *surface), emitter.path);
        else if (emitter.isInfinite())
            skies.add(nameOf(emitter.name, i), emitter.path);
    }
    features.describe("emission from surfaces", areas.any(),
                      areas.any() ? "area emitters: " + areas.names() : "no area emitter: emission is never seen",
                      areas.paths());
    features.describe("environment", skies.any(),
                      skies.any() ? "escaping rays see " + skies.names() : "no infinite emitter: escaping rays end",
                      skies.paths());
}

void describeSurfaces(const Scene& scene, Features& features) {
    const auto describe = [&](const std::string& name, LobeMask mask, const std::string& what,
                              const std::string& otherwise) {
        const SceneElements uses = elementsWithLobe(scene, mask);
        features.describe(name, uses.any(), uses.any() ? uses.counted("surface", what) : otherwise, uses.paths());
    };
    describe(feature::SurfaceScattering, lobe::Smooth, "with diffuse or glossy lobes",
             "every surface is specular, forward or black");
    describe(feature::SpecularCameraSubpaths, lobe::Specular, "with lobes that mirror or refract",
             "no mirror or smooth dielectric");
    describe(feature::Refraction, lobe::Transmissive, "with lobes that refract", "no surface refracts");
    describe(feature::IndexMatchedBoundaries, lobe::Forward, "with lobes that light passes straight",
             "no forward or transparent surface");
}

void describeSpeeds(const Scene& scene, const SceneFacts& facts, Features& features) {
    const Speeds speeds = reachableSpeeds(scene);
    const bool several = speeds.lowest < speeds.highest;
    features.describe("several speeds of light", facts.speedsDiffer,
                      several ? std::to_string(speeds.count) + " speeds, from " + brief(double(speeds.lowest)) +
                                    " to " + brief(double(speeds.highest))
                              : "one speed everywhere: " + brief(double(speeds.highest)),
                      speeds.elements);
}

void describeTextures(const Scene& scene, Features& features) {
    const SceneElements varying = elementsWithTexture(scene), transparent = elementsWithTransparency(scene);
    features.describe("textures", varying.any(),
                      varying.any() ? varying.counted("surface", "with parameters that vary over it")
                                    : "every surface parameter is constant",
                      varying.paths());
    features.describe("alpha", transparent.any(),
                      transparent.any() ? transparent.counted("surface", "of partial opacity")
                                        : "no surface has an opacity",
                      transparent.paths());
}

} // namespace

std::string nameOf(const std::string& name, size_t index) {
    return name.empty() ? "#" + std::to_string(index) : "'" + name + "'";
}

void Features::count(const FeatureName& feature, const std::vector<std::string>& counters) {
    for (Feature& described : all)
        if (described.name == feature)
            described.counters.insert(described.counters.end(), counters.begin(), counters.end());
}

std::string heterogeneity(const Scene& scene, const SceneFacts& facts) {
    if (facts.heterogeneousMedia.empty()) return "";
    SceneElements varying;
    for (const int index : facts.heterogeneousMedia)
        varying.add(nameOf(scene.media[size_t(index)].name, size_t(index)), scene.media[size_t(index)].path);
    return "coefficients vary from place to place in " + varying.names();
}

std::string whyNoScattering(const SceneFacts& facts) {
    if (facts.mediumScattering) return "";
    return facts.excludedMedia.empty() ? "no medium scatters"
                                       : "what scattering media show arrives after the sensor has closed";
}

Features featuresOf(const Scene& scene, const SceneFacts& facts) {
    Features features;
    describeTime(scene, facts, features);
    describeMedia(scene, features);
    describeSurfaces(scene, features);
    describeSpeeds(scene, facts, features);
    describeBounceCuts(scene, facts, features);
    describeEmission(scene, features);
    describeTextures(scene, features);
    return features;
}

} // namespace tungsten
