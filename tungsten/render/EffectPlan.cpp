#include "tungsten/render/EffectPlan.h"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <set>

namespace tungsten {

namespace {

std::string formatted(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", number);
    return text;
}

std::string describeGate(const TimeGate& gate) {
    if (gate.steadyState) return "no time gate: steady state";
    if (gate.delta) return "delta gate at time " + formatted(gate.start);
    const std::string interval = "[" + formatted(gate.start) + ", " + formatted(gate.end()) + ")";
    return gate.frames > 1
               ? std::to_string(gate.frames) + " frames of width " + formatted(gate.frameWidth) + " over " + interval
               : "one gate " + interval;
}

/// "name", or "#index" for the nameless.
std::string nameOf(const std::string& name, size_t index) {
    return name.empty() ? "#" + std::to_string(index) : "'" + name + "'";
}

/// First primitive with a lobe of `mask`, by name, and how many.
struct LobeUse {
    size_t count = 0;
    std::string first;
};
LobeUse usesOf(const Scene& scene, LobeMask mask) {
    LobeUse use;
    for (size_t i = 0; i < scene.primitives.size(); ++i) {
        const auto& bsdfs = scene.primitives[i].bsdfs;
        if (!std::any_of(bsdfs.begin(), bsdfs.end(), [mask](const BsdfPtr& b) { return (b->lobes() & mask) != 0; }))
            continue;
        if (use.count++ == 0) use.first = nameOf(scene.primitives[i].name, i);
    }
    return use;
}

std::string because(const LobeUse& use, const std::string& what, const std::string& otherwise) {
    if (use.count == 0) return otherwise;
    return std::to_string(use.count) + (use.count == 1 ? " surface " : " surfaces ") + what + ", first " + use.first;
}

/// Media that some path can be in: the camera's, the lights', and those that surfaces bound.
std::set<int> reachableMedia(const Scene& scene) {
    std::set<int> media{scene.cameraRegion.medium};
    for (const Emitter& emitter : scene.emitters) media.insert(emitter.medium);
    for (const Primitive& primitive : scene.primitives)
        if (primitive.boundsMedium) media.insert({primitive.inside.medium, primitive.outside.medium});
    media.erase(-1);
    return media;
}

std::set<float> speedsOf(const Scene& scene) {
    std::set<float> speeds{scene.cameraRegion.speed};
    for (const Emitter& emitter : scene.emitters) speeds.insert(scene.regionOf(emitter).speed);
    for (const Primitive& primitive : scene.primitives)
        if (primitive.boundsRegion) speeds.insert({primitive.inside.speed, primitive.outside.speed});
    return speeds;
}

void planMedia(const Scene& scene, EffectPlan& plan) {
    std::string scattering, coloured;
    for (const int index : reachableMedia(scene)) {
        const Medium& medium = scene.media[size_t(index)];
        if (medium.scatters()) scattering += (scattering.empty() ? "" : ", ") + nameOf(medium.name, size_t(index));
        if (!medium.isHomogeneous())
            plan.heterogeneousMedia +=
                (plan.heterogeneousMedia.empty() ? "" : ", ") + nameOf(medium.name, size_t(index));
        if (!medium.isGrey()) coloured += (coloured.empty() ? "" : ", ") + nameOf(medium.name, size_t(index));
    }
    plan.mediumScattering = !scattering.empty();
    plan.greyMedia = coloured.empty();
    plan.describe("medium scattering", plan.mediumScattering,
                  scattering.empty() ? "no reachable medium scatters" : "scattering media: " + scattering);
    plan.describe("coloured media", !plan.greyMedia,
                  coloured.empty() ? "every medium has the same coefficients in R, G and B" : "coloured: " + coloured);
}

void planEmission(const Scene& scene, EffectPlan& plan) {
    std::string areas, skies;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        const auto surface = emitter.primitive();
        if (!surface && !emitter.isInfinite()) continue;
        std::string& names = surface ? areas : skies;
        const std::string name = surface ? scene.primitives[*surface].name : emitter.name;
        names += (names.empty() ? "" : ", ") + nameOf(name, surface.value_or(i));
    }
    plan.surfaceEmission = !areas.empty();
    plan.environment = !skies.empty();
    plan.describe("emission from surfaces", plan.surfaceEmission,
                  areas.empty() ? "no area emitter: emission is never seen" : "area emitters: " + areas);
    plan.describe("environment", plan.environment,
                  skies.empty() ? "no infinite emitter: escaping rays end" : "escaping rays see " + skies);
}

bool hasTextures(const Scene& scene) {
    for (const Primitive& primitive : scene.primitives)
        for (const BsdfPtr& bsdf : primitive.bsdfs)
            if (!bsdf->albedo.isConstant() || bsdf->bump) return true;
    return false;
}

std::string spanOf(const TimeProfile& profile) {
    return formatted(profile.times.front()) + " to " + formatted(profile.times.back());
}

/// What sensor and lights do with time beyond frames and flashes.
void describeTimes(const Scene& scene, EffectPlan& plan) {
    const TimeProfile &response = scene.transport.response, &delay = scene.transport.delay;
    if (!response.empty())
        plan.describe("temporal response", true,
                      "times of arrival are weighed by " + std::to_string(response.times.size()) + " values");
    if (!delay.empty())
        plan.describe("temporal response", true, "light is recorded " + spanOf(delay) + " after its arrival");
    std::string pulses;
    for (const Emitter& emitter : scene.emitters)
        if (!emitter.pulse.empty())
            pulses += (pulses.empty() ? "'" : ", '") + emitter.name + "' shines from " + spanOf(emitter.pulse);
    if (pulses.empty()) return;
    plan.describe("pulses", plan.timeResolved,
                  plan.timeResolved ? pulses + " after its emission_time" : "in steady state all light counts at once");
}

} // namespace

EffectPlan analyseScene(const Scene& scene) {
    EffectPlan plan;
    plan.timeResolved = !scene.transport.gate.steadyState;
    plan.multipleFrames = scene.transport.gate.frames > 1;
    plan.describe("time of flight", plan.timeResolved, describeGate(scene.transport.gate));
    describeTimes(scene, plan);
    planMedia(scene, plan);

    const LobeUse smooth = usesOf(scene, lobe::Smooth), specular = usesOf(scene, lobe::Specular),
                  forward = usesOf(scene, lobe::Forward);
    plan.surfaceScattering = smooth.count > 0;
    plan.specularSensorPaths = specular.count > 0;
    plan.forwardBoundaries = forward.count > 0;
    plan.describe("surface scattering", plan.surfaceScattering,
                  because(smooth, "with diffuse or glossy lobes", "every surface is specular, forward or black"));
    plan.describe("specular sensor paths", plan.specularSensorPaths,
                  because(specular, "that mirror or refract", "no mirror or smooth dielectric"));
    plan.describe("index-matched boundaries", plan.forwardBoundaries,
                  because(forward, "that light passes straight", "no forward or transparent surface"));

    const std::set<float> speeds = speedsOf(scene);
    plan.speedsDiffer = plan.timeResolved && speeds.size() > 1;
    plan.highestSpeed = *speeds.rbegin();
    plan.describe("several speeds of light", plan.speedsDiffer,
                  speeds.size() > 1
                      ? std::to_string(speeds.size()) + " speeds, from " + formatted(double(*speeds.begin())) + " to " +
                            formatted(double(*speeds.rbegin()))
                      : "one speed everywhere: " + formatted(double(*speeds.begin())));
    planEmission(scene, plan);
    plan.textures = hasTextures(scene);
    plan.describe("textures", plan.textures,
                  plan.textures ? "albedo or bump varies over some surface" : "every surface parameter is constant");
    return plan;
}

void printPlan(const EffectPlan& plan, std::ostream& out) {
    size_t width = 0;
    for (const Effect& effect : plan.effects) width = std::max(width, effect.name.size());
    for (const Effect& effect : plan.effects)
        out << "  " << (effect.on ? "on " : "off") << "  " << std::left << std::setw(int(width)) << effect.name << "  "
            << effect.reason << '\n';
}

} // namespace tungsten
