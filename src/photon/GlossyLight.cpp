#include "photon/GlossyLight.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// Whether a straight path ends on a glossy surface.
struct EndsGlossy {
    bool& glossy;
    void segment(const SensorState&, float) const {}
    void surface(const SensorState&, const SurfaceInteraction& surface) const { glossy = isGlossyOnly(*surface.bsdf); }
    void escaped(const SensorState&) const {}
};

/// Pixels whose centre, or a neighbour's, shows a glossy surface straight on. Chosen before any sample is drawn, so
/// that the number of samples does not depend on them.
std::vector<uint8_t> pixelsNearGlossy(const Scene& scene) {
    const int width = scene.camera.resolution.x, height = scene.camera.resolution.y;
    std::vector<uint8_t> centres(size_t(width) * size_t(height)), near(centres.size());
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            Sampler sampler(0, RandomStream::Target, 0, size_t(y) * size_t(width) + size_t(x));
            bool glossy = false;
            const Ray ray = scene.camera.generateRay({x, y}, Vec2f(0.5f), Vec2f(0.5f));
            followSensorPath(scene, {ray, scene.cameraRegion}, {false, false}, sampler, EndsGlossy{glossy});
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

GlossyLight::GlossyLight(const Scene& scene) : scene_(scene), lights_(scene), oversampled_(pixelsNearGlossy(scene)) {}

std::optional<ArrivedLight> GlossyLight::connect(const Sensor& sensor, const SensorState& state,
                                                 const SurfaceInteraction& surface, Sampler& sampler,
                                                 uint64_t& rays) const {
    const auto choice = lights_.sample(sampler.next1D());
    if (!choice) return std::nullopt;
    const Emitter& emitter = *choice->emitter;
    const auto direct = sampleDirect(emitter, surface.hit.position, sampler.next2D());
    if (!direct || !surface.consistent(direct->direction, scene_.transport.consistencyChecks)) return std::nullopt;
    const BsdfQuery query = surface.query(TransportMode::Radiance);
    const Vec3f wo = surface.frame.toLocal(direct->direction);
    const Rgb scattering = surface.bsdf->eval(query, surface.wi, wo);
    if (isBlack(scattering)) return std::nullopt;
    const Region region = regionBeyond(surface, direct->direction, state.region);
    const double start = emitter.emissionTime + state.time + double(surface.hit.t) / double(state.region.speed);
    const double soonest = start + double(direct->distance) / double(highestSpeed(scene_));
    if (!sensor.gate.steadyState && soonest >= sensor.gate.end()) return std::nullopt;
    const Visibility visibility = traceVisibility(scene_, surface.hit.position, true, direct->direction,
                                                  direct->distance, emitter.isArea(), region, rays);
    const int interactions = state.interactions + 1 + visibility.crossings;
    if (isBlack(visibility.transmittance) || interactions < scene_.transport.minBounces ||
        interactions >= scene_.transport.maxBounces)
        return std::nullopt;
    float weight = 1.0f / choice->probability;
    if (direct->pdf > 0.0f)
        weight *= powerHeuristic(direct->pdf * choice->probability, surface.bsdf->pdf(query, surface.wi, wo));
    return ArrivedLight{state.throughput * scattering * direct->weight * visibility.transmittance * weight,
                        start + visibility.time};
}

float GlossyLight::emissionWeight(const SensorState& state, const SurfaceInteraction& light) const {
    if (!(state.glossyPdf > 0.0f)) return 0.0f;
    const int index = light.primitive->emitter;
    const float lightPdf =
        pdfDirect(scene_.emitters[size_t(index)], state.glossyVertex, light.hit.position, light.hit.ng) *
        lights_.probability(index);
    return powerHeuristic(state.glossyPdf, lightPdf);
}

} // namespace tungsten::photon
