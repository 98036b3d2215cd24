#include "path/techniques/LightVertices.h"

#include "transport/Balance.h"

#include <tbb/parallel_for.h>

namespace tungsten::path {

namespace {

bool scattersSmoothly(const Bsdf& bsdf) {
    const LobeMask lobes = bsdf.lobes();
    return (lobes & lobe::Smooth) != 0 && (lobes & lobe::Through) == 0;
}

} // namespace

std::optional<LightVertex> traceLightVertex(const Scene& scene, const Emitter& emitter, float probability,
                                            Sampler& sampler) {
    const Vec2f uPosition = sampler.next2D();
    const EmissionSample emission = sampleEmission(emitter, uPosition, sampler.next2D());
    const Vec3f direction = emission.ray.direction;
    const auto hit = scene.geometry->intersect(emission.ray);
    if (!hit || !scattersSmoothly(scene.bsdfOf(*hit))) return std::nullopt;
    LightVertex vertex;
    vertex.surface = makeInteraction(scene, *hit, direction);
    vertex.toLight = -direction;
    const float cosine = std::abs(direction.dot(hit->ng));
    if (!(cosine > 0.0f) || !vertex.surface.consistent(vertex.toLight, scene.transport.consistencyChecks))
        return std::nullopt;
    vertex.power = emission.power / (cosine * probability);
    vertex.distance = hit->t;
    vertex.areaPdf = emission.pdfDirection * cosine / sqr(hit->t);
    vertex.lightPdf = pdfDirect(emitter, hit->position, emission.ray.origin, emission.normal);
    if (isBlack(vertex.power)) return std::nullopt;
    return vertex;
}

Rgb LightVertex::scattered(const Vec3f& direction) const {
    if (!mayBeLightVertex(surface, direction, toLight)) return Rgb(0.0f);
    const Vec3f wi = surface.frame.toLocal(direction), wo = surface.frame.toLocal(toLight);
    const BsdfQuery query = surface.query(TransportMode::Radiance);
    const Rgb value = surface.bsdf->eval(query, wi, wo) * power;
    return lightPdf > 0.0f ? value * transport::powerHeuristic(lightPdf, surface.bsdf->pdf(query, wi, wo)) : value;
}

bool mayBeLightVertex(const SurfaceInteraction& surface, const Vec3f& toVertex, const Vec3f& toLight) {
    return scattersSmoothly(*surface.bsdf) && toVertex.dot(surface.hit.ng) * toLight.dot(surface.hit.ng) > 0.0f;
}

void LightVertexCache::trace(const Scene& scene, const Emitter& emitter, float probability, size_t paths,
                             const PassInfo& pass) {
    std::vector<std::optional<LightVertex>> found(paths);
    const auto stream = uint64_t(&emitter - scene.emitters.data()) << 32;
    tbb::parallel_for(size_t(0), paths, [&](size_t i) {
        Sampler sampler(pass.seed, RandomStream::LightVertex, pass.index, stream | i);
        found[i] = traceLightVertex(scene, emitter, probability, sampler);
    });
    paths_ = paths;
    vertices_.clear();
    for (const auto& vertex : found)
        if (vertex) vertices_.push_back(*vertex);
    window_.fill(vertices_.size(),
                 [this](size_t i) { return std::pair(vertices_[i].surface.hit.position, vertices_[i].distance); });
}

auto LightVertexCache::choose(const Vec3f& position, float low, float high, const Vec2f& u) const -> Choice {
    // Rough contributions, beside walks with even directions.
    const auto importance = [&](size_t i, float squared) {
        const LightVertex& vertex = vertices_[i];
        const Vec3f offset = position - vertex.surface.hit.position;
        const float cosine = std::abs(offset.dot(vertex.surface.hit.ng)) / std::sqrt(squared);
        const float walkPdf = 0.25f * InvPi * cosine / squared, candidates = candidateDensity(vertex.areaPdf);
        return maxComponent(vertex.power) * walkPdf * candidates / (candidates + walkPdf);
    };
    const auto choice = window_.choose(position, low, high, u, importance);
    if (!choice) return {};
    const float each = float(vertices_.size()) / (float(paths_) * float(Candidates));
    return {&vertices_[choice->index], each * choice->inverseProbability};
}

} // namespace tungsten::path
