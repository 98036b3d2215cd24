#include "photon/view/LightConnection.h"

namespace tungsten::photon {

LightConnector::LightConnector(const Scene& scene, const EffectPlan& plan)
    : scene_(scene), lights_(scene), highestSpeed_(double(plan.highestSpeed)), oneSpeed_(!plan.speedsDiffer) {}

/// Of light that leaves at `start`; the exact test is left to the frames.
bool LightConnector::mayArrive(const TimeGate& gate, double start, double distance) const {
    if (gate.steadyState) return true;
    const double soonest = start + distance / highestSpeed_, slack = 1e-5 * std::abs(soonest);
    return soonest < gate.end() + slack && (!oneSpeed_ || soonest >= gate.start - slack);
}

std::optional<LightConnection> LightConnector::connect(const Sensor& sensor, const SensorState& state,
                                                       const SurfaceInteraction& surface, Sampler& sampler,
                                                       uint64_t& rays) const {
    const auto choice = lights_.sample(sampler.next1D());
    if (!choice) return std::nullopt;
    const Emitter& emitter = *choice->emitter;
    const auto direct = sampleDirect(emitter, surface.hit.position, sampler.next2D());
    if (!direct) return std::nullopt;
    const TransportSettings& transport = scene_.transport;
    const double cameraTime = state.time + double(surface.hit.t) / double(state.region.speed);
    const double start = emitter.emissionTime + (transport.cameraUnwarped ? 0.0 : cameraTime);
    if (!mayArrive(sensor.gate, start, double(direct->distance))) return std::nullopt;
    if (!surface.consistent(direct->direction, transport.consistencyChecks)) return std::nullopt;
    const Rgb scattering = surface.bsdf->eval(surface.query(TransportMode::Radiance, lobe::Smooth), surface.wi,
                                              surface.frame.toLocal(direct->direction));
    if (isBlack(scattering)) return std::nullopt;
    Ray ray = surface.hit.leave(direct->direction);
    ray.tMax = direct->reach();
    const Visibility visibility =
        traceVisibility(scene_, ray, direct->distance, regionBeyond(surface, direct->direction, state.region), rays);
    const int interactions = state.interactions + 1 + visibility.crossings;
    if (isBlack(visibility.transmittance) || interactions < transport.minBounces ||
        interactions >= transport.maxBounces)
        return std::nullopt;
    const Rgb radiance =
        state.throughput * scattering * direct->weight * visibility.transmittance / choice->probability;
    return LightConnection{&emitter, choice->probability, *direct, {radiance, start + visibility.time}};
}

} // namespace tungsten::photon
