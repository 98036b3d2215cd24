#include "photon/view/GlossyLight.h"

#include "transport/Balance.h"

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
    : scene_(scene), lights_(scene, facts), oversampled_(pixelsNearGlossy(scene)) {}

std::optional<ArrivedLight> GlossyLight::connect(const transport::TimeSensor& sensor, const CameraSubpath& state,
                                                 const SurfaceInteraction& surface, Sampler& sampler,
                                                 uint64_t& rays) const {
    const auto light = lights_.connect(sensor, state, surface, sampler, rays);
    if (!light || !(light->direct.pdf > 0.0f)) return light ? std::optional(light->arrived) : std::nullopt;
    const BsdfQuery query = surface.query(TransportMode::Radiance);
    const float bsdfPdf = surface.bsdf->pdf(query, surface.wi, surface.frame.toLocal(light->direct.direction));
    const float weight = transport::powerHeuristic(light->direct.pdf * light->probability, bsdfPdf);
    return ArrivedLight{light->arrived.radiance * weight, light->arrived.time};
}

float GlossyLight::emissionWeight(const CameraSubpath& state, const SurfaceInteraction& light) const {
    if (!(state.glossyPdf > 0.0f)) return 0.0f;
    const int index = light.primitive->emitter;
    const float lightPdf =
        pdfDirect(scene_.emitters[size_t(index)], state.glossyVertex, light.hit.position, light.hit.ng) *
        lights_.lights().probability(index);
    return transport::powerHeuristic(state.glossyPdf, lightPdf);
}

} // namespace tungsten::photon
