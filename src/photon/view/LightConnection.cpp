#include "photon/view/LightConnection.h"

#include "transport/BounceLimits.h"

namespace tungsten::photon {

LightConnector::LightConnector(const Scene& scene, const SceneFacts& facts)
    : scene_(scene), lights_(scene, facts.excludedEmitters),
      connector_(scene, facts.forwardBoundaries || facts.everything), bounds_(scene.transport.gate, facts) {}

std::optional<LightConnection> LightConnector::connect(const transport::TimeSensor& sensor, const CameraSubpath& state,
                                                       const SurfaceInteraction& surface, Sampler& sampler,
                                                       uint64_t& rays) const {
    const auto choice = lights_.sample(sampler.next1D());
    if (!choice) return std::nullopt;
    const Emitter& emitter = *choice->emitter;
    const auto direct = sampleDirect(emitter, surface.hit.position, sampler.next2D());
    if (!direct) return std::nullopt;
    const TransportSettings& settings = scene_.transport;
    const double cameraTime = state.time + double(surface.hit.t) / double(state.region.speed);
    const double start =
        emitter.emissionTime + sensor.delays.sample(emitter, sampler) + (settings.cameraUnwarped ? 0.0 : cameraTime);
    if (!bounds_.during(sensor.gate).mayArrive(start, double(direct->distance))) return std::nullopt;
    const transport::Vertex vertex(scene_, surface, state.ray.direction, TransportMode::Radiance, state.region);
    const auto connection = connector_.connect(vertex, state.throughput, transport::connectionEndpoint(*direct), rays);
    if (!connection) return std::nullopt;
    if (!transport::BounceLimits(settings).renders(state.interactions + 1 + connection->crossings)) return std::nullopt;
    return LightConnection{&emitter,
                           choice->probability,
                           *direct,
                           {connection->throughput / choice->probability, start + connection->time}};
}

} // namespace tungsten::photon
