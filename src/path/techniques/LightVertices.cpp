#include "path/techniques/LightVertices.h"

#include "transport/Balance.h"

#include <tbb/parallel_for.h>

namespace tungsten::path {

bool holdsLightVertices(LobeMask lobes) {
    return (lobes & lobe::Smooth) != 0 && (lobes & lobe::Through) == 0;
}

std::optional<LightVertex> traceLightVertex(const Scene& scene, const Emitter& emitter, float probability,
                                            Sampler& sampler) {
    const Vec2f uPosition = sampler.next2D();
    const EmissionSample emission = sampleEmission(emitter, uPosition, sampler.next2D());
    const Vec3f direction = emission.ray.direction;
    const auto hit = scene.geometry->intersect(emission.ray);
    if (!hit || !holdsLightVertices(scene.bsdfOf(*hit).lobes()) || isBlack(emission.power)) return std::nullopt;
    const float incidence = std::abs(direction.dot(hit->ng));
    if (!(incidence > 0.0f)) return std::nullopt;
    const SurfaceInteraction surface = makeInteraction(scene, *hit, direction);
    if (!surface.consistent(-direction, scene.transport.consistencyChecks)) return std::nullopt;
    const transport::Vertex vertex(scene, surface, direction, TransportMode::Photons, scene.regionOf(emitter));
    return LightVertex{vertex,
                       emission.power / probability,
                       hit->t,
                       vertex.areaDensity(emission.pdfDirection, direction, hit->t),
                       pdfDirect(emitter, hit->position, emission.ray.origin, emission.normal),
                       incidence};
}

Rgb LightVertex::intensity(const Vec3f& direction) const {
    if (!vertex.reflects(direction)) return Rgb(0.0f);
    const Rgb value = power * vertex.scattering(direction);
    return lightPdf > 0.0f ? value * transport::powerHeuristic(lightPdf, vertex.pdfReverse(direction)) : value;
}

void LightVertexCache::trace(const Scene& scene, const Emitter& emitter, float probability, size_t paths,
                             const PassInfo& pass) {
    std::vector<std::optional<LightVertex>> found(paths);
    const auto stream = uint64_t(&emitter - scene.emitters.data()) << 32;
    pass.watch.stage("light paths", paths);
    tbb::parallel_for(size_t(0), paths, [&](size_t i) {
        pass.watch.pollEvery(256, i);
        Sampler sampler(pass.seed, RandomStream::LightVertex, pass.index, stream | i);
        found[i] = traceLightVertex(scene, emitter, probability, sampler);
    });
    paths_ = paths;
    vertices_.clear();
    for (const auto& vertex : found)
        if (vertex) vertices_.push_back(*vertex);
    window_.fill(vertices_.size(),
                 [this](size_t i) { return std::pair(vertices_[i].vertex.position(), vertices_[i].distance); });
}

auto LightVertexCache::choose(const Vec3f& position, float low, float high, const Vec2f& u) const -> Choice {
    // Rough contributions, beside walks with even directions.
    const auto importance = [&](size_t i, const Vec3f& direction, float distance) {
        const LightVertex& vertex = vertices_[i];
        const float walkPdf = vertex.vertex.areaDensity(0.25f * InvPi, direction, distance);
        const float candidates = candidateDensity(vertex.areaPdf);
        return maxComponent(vertex.power) / vertex.incidence * walkPdf * candidates / (candidates + walkPdf);
    };
    const auto choice = window_.choose(position, low, high, u, importance);
    if (!choice) return {};
    const float each = float(vertices_.size()) / (float(paths_) * float(Candidates));
    return {&vertices_[choice->index], each * choice->inverseProbability};
}

} // namespace tungsten::path
