#pragma once
// A camera path of the sensor pass: straight through forward surfaces and along specular lobes. What is done on the way
// is a visitor's: gathering photons, or recording where photons are wanted.

#include "tungsten/scene/Interaction.h"

namespace tungsten::photon {

/// Where a camera path has got to.
struct SensorState {
    Ray ray;
    Region region;
    Rgb throughput{1.0f};
    double time = 0.0; ///< of flight from the camera to the ray's origin
    int interactions = 0;
    bool folded = false; ///< a mirror or refraction lies behind
};

/// Follows the path from `state`. `specular`: along specular lobes too, not only straight on. The visitor has
///   segment(state, length): the ray ahead up to `length`, possibly infinite, in state.region
///   surface(state, interaction): the end of the segment; the throughput includes the way there, the time does not
///   escaped(state)
/// Returns the number of rays.
template <typename Visitor>
uint64_t followSensorPath(const Scene& scene, SensorState state, bool specular, Sampler& sampler, Visitor&& visitor) {
    uint64_t rays = 0;
    while (state.interactions < scene.transport.maxBounces) {
        ++rays;
        const auto hit = scene.geometry->intersect(state.ray);
        const float length = hit ? hit->t : Infinity;
        visitor.segment(state, length);
        if (const Medium* medium = scene.medium(state.region))
            state.throughput = state.throughput * medium->transmittance(length);
        if (!hit) {
            visitor.escaped(state);
            return rays;
        }
        if (isBlack(state.throughput)) return rays;
        const SurfaceInteraction surface = makeInteraction(scene, *hit, state.ray.direction);
        visitor.surface(state, surface);
        state.time += double(length) / double(state.region.speed);
        ++state.interactions;
        const LobeMask followed = specular ? lobe::Specular | lobe::Forward : lobe::Forward;
        const auto exit = sampleExit(surface, surface.query(TransportMode::Radiance, followed),
                                     scene.transport.consistencyChecks, sampler);
        if (!exit) return rays;
        state.folded = state.folded || !exit->straight();
        state.throughput = state.throughput * exit->weight;
        state.region = regionBeyond(surface, exit->direction, state.region);
        state.ray = Ray{hit->position, exit->direction, scene.rayEpsilon};
    }
    return rays;
}

} // namespace tungsten::photon
