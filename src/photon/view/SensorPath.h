#pragma once
// A camera path of the sensor pass: straight through forward surfaces and along specular lobes. What is done on the way
// is a visitor's: gathering photons, or recording where photons are wanted.

#include "transport/StepCounters.h"

#include "tungsten/scene/Interaction.h"

namespace tungsten::photon {

/// Surfaces with glossy lobes alone: almost mirrors.
inline bool isGlossyOnly(const Bsdf& bsdf) {
    return (bsdf.lobes() & lobe::Smooth) != 0 && (bsdf.lobes() & lobe::DiffuseReflection) == 0;
}

/// Surfaces that connections end on. Through a glossy lobe alone they find its peak too rarely: photons are left to it.
inline bool receivesConnections(const Bsdf& bsdf) {
    return (bsdf.lobes() & lobe::DiffuseReflection) != 0;
}

/// What a camera path follows besides going straight on.
struct SensorPathRules {
    bool specular = true; ///< mirrors and refraction
    /// Surfaces that are glossy only, along a sampled direction. They look for light themselves; photons bring only
    /// what comes from lights through mirrors and refraction, or from lights of a single direction.
    bool glossy = false;

    [[nodiscard]] LobeMask followed(const Bsdf& bsdf) const {
        if (glossy && isGlossyOnly(bsdf)) return lobe::All;
        return specular ? lobe::Specular | lobe::Forward : lobe::Forward;
    }
};

/// Where a camera path has got to.
struct SensorState {
    Ray ray;
    Region region;
    Rgb throughput{1.0f};
    double time = 0.0; ///< of flight from the camera to the ray's origin
    int interactions = 0;
    bool folded = false;    ///< a mirror, refraction or glossy surface lies behind
    bool glossy = false;    ///< a glossy surface lies behind
    float glossyPdf = 0.0f; ///< of the ray's direction, per solid angle, if the path has only gone straight since there
    Vec3f glossyVertex{0.0f};
};

/// What following a path took.
struct SensorSteps : transport::StepCounters {
    uint64_t glossy = 0; ///< glossy: surfaces left along a glossy lobe

    SensorSteps& operator+=(const SensorSteps& other) {
        StepCounters::operator+=(other);
        glossy += other.glossy;
        return *this;
    }
};

/// Shows a visitor what lies ahead of `state`, up to `hit` if there is one. The visitor has
///   segment(state, hit): the ray ahead, up to the surface if there is one, in state.region
///   surface(state, interaction): the end of the segment; the throughput includes the way there, the time does not
///   escaped(state)
/// Returns the surface, if light gets through from there.
template <typename Visitor>
std::optional<SurfaceInteraction> visitLeg(const Scene& scene, SensorState& state, const std::optional<SurfaceHit>& hit,
                                           Visitor&& visitor) {
    visitor.segment(state, hit);
    if (const Medium* medium = scene.medium(state.region))
        state.throughput = state.throughput * medium->transmittance(hit ? hit->t : Infinity);
    if (!hit) visitor.escaped(state);
    if (!hit || isBlack(state.throughput)) return std::nullopt;
    const SurfaceInteraction surface = makeInteraction(scene, *hit, state.ray.direction);
    visitor.surface(state, surface);
    return surface;
}

/// Follows the path from `state`, leg by leg.
template <typename Visitor>
SensorSteps followSensorPath(const Scene& scene, SensorState state, const SensorPathRules& rules, Sampler& sampler,
                             Visitor&& visitor, const PassWatch& watch = {}) {
    SensorSteps steps;
    while (state.interactions < scene.transport.maxBounces) {
        steps.step(watch);
        ++steps.rays;
        const auto hit = scene.geometry->intersect(state.ray);
        if (const Medium* medium = scene.medium(state.region)) steps.fly(*medium);
        const auto found = visitLeg(scene, state, hit, visitor);
        if (!found) return steps;
        const SurfaceInteraction& surface = *found;
        state.time += double(hit->t) / double(state.region.speed);
        ++state.interactions;
        ++steps.surfaceEvents;
        sampler.at(state.interactions, Draw::Direction);
        const auto exit = sampleExit(surface, surface.query(TransportMode::Radiance, rules.followed(*surface.bsdf)),
                                     scene.transport.consistencyChecks, sampler);
        if (!exit) return steps;
        steps.leave(exit->lobe);
        state.folded = state.folded || !exit->straight();
        if ((exit->lobe & lobe::Smooth) != 0) {
            ++steps.glossy;
            state.glossy = true;
            state.glossyPdf = exit->pdf;
            state.glossyVertex = hit->position;
        } else if (!exit->straight()) {
            state.glossyPdf = 0.0f;
        }
        state.throughput = state.throughput * exit->weight;
        if (isBlack(state.throughput)) return steps;
        state.region = regionBeyond(surface, exit->direction, state.region);
        state.ray = hit->leave(exit->direction);
    }
    return steps;
}

inline void report(const SensorSteps& steps, Statistics& statistics) {
    statistics.add("rays", steps.rays);
    statistics.add("glossy sensor reflections", steps.glossy);
    transport::reportSteps(steps, statistics);
}

/// A visitor of surfaces alone: `look(state, interaction)`.
template <typename Look>
struct SurfaceVisitor {
    Look look;
    void segment(const SensorState&, const std::optional<SurfaceHit>&) const {}
    void surface(const SensorState& state, const SurfaceInteraction& surface) const { look(state, surface); }
    void escaped(const SensorState&) const {}
};
template <typename Look>
SurfaceVisitor(Look) -> SurfaceVisitor<Look>;

} // namespace tungsten::photon
