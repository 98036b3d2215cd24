#include "photon/view/GlossyLight.h"

#include "transport/Balance.h"
#include "transport/BounceLimits.h"

#include "tungsten/emitter/Emitter.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// Pixels whose centre, or a neighbour's, shows a glossy surface straight on. Chosen before any sample is drawn, so
/// that the number of samples does not depend on them.
std::vector<uint8_t> pixelsNearGlossy(const Scene& scene) {
    const int width = scene.camera.resolution.x, height = scene.camera.resolution.y;
    std::vector<uint8_t> centres(size_t(width) * size_t(height)), near(centres.size());
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            Sampler sampler(0, RandomStream::Emitter, 0, size_t(y) * size_t(width) + size_t(x));
            bool glossy = false;
            const Ray ray = scene.camera.generateRay({x, y}, Vec2f(0.5f), Vec2f(0.5f));
            // The last surface of a straight path counts.
            const SurfaceVisitor visitor{
                [&](const CameraSubpath&, const SurfaceInteraction& surface) { glossy = isGlossyOnly(*surface.bsdf); }};
            followCameraSubpath(scene, ray, {false, false}, sampler, visitor);
            centres[size_t(y) * size_t(width) + size_t(x)] = glossy;
        }
    });
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
                    near[size_t(y) * size_t(width) + size_t(x)] |= centres[size_t(v) * size_t(width) + size_t(u)];
    return near;
}

} // namespace

GlossyLight::GlossyLight(const Scene& scene, const SceneFacts& facts)
    : scene_(scene), lights_(scene, facts.excludedEmitters),
      connector_(scene, facts.forwardBoundaries || facts.everything), bounds_(scene.transport.gate, facts),
      oversampled_(pixelsNearGlossy(scene)) {}

std::optional<ArrivedLight> GlossyLight::connect(const transport::TimeSensor& sensor, const CameraSubpath& state,
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
    ArrivedLight light{connection->throughput / choice->probability, start + connection->time};
    if (direct->pdf > 0.0f) {
        const float bsdfPdf = surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi,
                                                surface.frame.toLocal(direct->direction));
        light.radiance = light.radiance * transport::powerHeuristic(direct->pdf * choice->probability, bsdfPdf);
    }
    return light;
}

float GlossyLight::emissionWeight(const CameraSubpath& state, const SurfaceInteraction& light) const {
    if (!(state.glossyPdf > 0.0f)) return 0.0f;
    const int index = light.primitive->emitter;
    const float lightPdf =
        pdfDirect(scene_.emitters[size_t(index)], state.glossyVertex, light.hit.position, light.hit.ng) *
        lights_.probability(index);
    return transport::powerHeuristic(state.glossyPdf, lightPdf);
}

} // namespace tungsten::photon
