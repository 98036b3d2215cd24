#include "path/techniques/ReflectedLight.h"

#include "path/Tuning.h"

#include <tbb/parallel_for.h>

namespace tungsten::path {

namespace {

constexpr uint32_t PilotPass = std::numeric_limits<uint32_t>::max();

/// Adds up to two ends of one light path: where it meets the next surface, and a point before.
void traceReflection(const Scene& scene, const Emitter& emitter, float probability, const Flights& flights,
                     Sampler sampler, std::vector<ReflectedVertex>& vertices) {
    const auto glossy = traceLightVertex(scene, emitter, probability, sampler);
    if (!glossy || !reflectsSharply(*glossy->surface.bsdf)) return;
    const SurfaceInteraction& from = glossy->surface;
    const BsdfQuery query = from.query(TransportMode::Radiance);
    const Vec2f uDirection = sampler.next2D();
    const auto sample = from.bsdf->sample(query, from.wi, {uDirection, sampler.next1D()});
    if (!sample || (sample->lobe & lobe::Smooth) == 0) return;
    const Vec3f direction = from.frame.toWorld(sample->wo).normalized();
    const float pdf = from.bsdf->pdf(query, from.wi, from.frame.toLocal(direction));
    const Rgb scattered = glossy->scattered(direction);
    if (!(pdf > 0.0f) || isBlack(scattered) || !from.consistent(direction, scene.transport.consistencyChecks)) return;

    const float cosine = std::abs(direction.dot(from.hit.ng));
    const Rgb power = scattered * (cosine / pdf);
    const auto end = [&](float flight, float density) {
        ReflectedVertex vertex;
        vertex.position = from.hit.position + direction * flight;
        vertex.toGlossy = -direction;
        vertex.flight = flight;
        vertex.length = glossy->distance + flight;
        vertex.power = power;
        vertex.density = glossy->areaPdf * pdf * density / sqr(flight);
        vertex.walkGeometry = cosine / sqr(flight);
        vertex.glossy = *glossy;
        return vertex;
    };
    const Ray onward = from.hit.leave(direction);
    const auto hit = scene.geometry->intersect(onward);
    const float flight = flights.sample(sampler.next1D()), density = flights.pdf(flight);
    if (flight > onward.tMin && density > 0.0f && (!hit || flight < hit->t)) {
        vertices.push_back(end(flight, density));
        vertices.back().power = power / density;
    }
    if (!hit || !endsReflectedLight(scene.bsdfOf(*hit))) return;
    const float cosineHere = std::abs(direction.dot(hit->ng));
    if (!(cosineHere > 0.0f)) return;
    ReflectedVertex vertex = end(hit->t, cosineHere);
    vertex.surface = makeInteraction(scene, *hit, direction);
    vertex.position = hit->position;
    vertex.power = power / cosineHere;
    vertices.push_back(vertex);
    return;
}

} // namespace

bool reflectsSharply(const Bsdf& bsdf) {
    const LobeMask lobes = bsdf.lobes();
    return (lobes & lobe::GlossyReflection) != 0 && (lobes & lobe::Through) == 0;
}

bool endsReflectedLight(const Bsdf& bsdf) {
    const LobeMask lobes = bsdf.lobes();
    return (lobes & lobe::Smooth) != 0 && (lobes & (lobe::Specular | lobe::Through)) == 0;
}

void ReflectedLightCache::prepare(const Scene& scene, const Emitter& emitter, const Flights& flights) {
    trace(scene, emitter, 1.0f, tuning::PilotPaths, PassInfo{.index = PilotPass}, flights);
    candidates_ =
        vertices_.empty() ? 0.0f : float(ArrivalWindow::Size) * float(tuning::PilotPaths) / float(vertices_.size());
}

void ReflectedLightCache::trace(const Scene& scene, const Emitter& emitter, float probability, size_t paths,
                                const PassInfo& pass, const Flights& flights) {
    constexpr size_t Block = 1024;
    std::vector<std::vector<ReflectedVertex>> found((paths + Block - 1) / Block);
    const auto stream = uint64_t(&emitter - scene.emitters.data()) << 32;
    tbb::parallel_for(size_t(0), found.size(), [&](size_t block) {
        for (size_t i = block * Block; i < std::min(paths, (block + 1) * Block); ++i)
            traceReflection(scene, emitter, probability, flights,
                            Sampler(pass.seed, RandomStream::ReflectedLight, pass.index, stream | i), found[block]);
    });
    paths_ = paths;
    vertices_.clear();
    for (const auto& block : found) vertices_.insert(vertices_.end(), block.begin(), block.end());
    window_.fill(vertices_.size(), [this](size_t i) { return std::pair(vertices_[i].position, vertices_[i].length); });
}

auto ReflectedLightCache::choose(const Vec3f& position, float low, float high, const Vec2f& u) const -> Choice {
    // Rough contributions, beside walks with even directions.
    const auto importance = [&](size_t i, float squared) {
        const ReflectedVertex& vertex = vertices_[i];
        float walkPdf = 0.25f * InvPi / squared;
        if (vertex.surface)
            walkPdf *= std::abs((position - vertex.position).dot(vertex.surface->hit.ng)) / std::sqrt(squared);
        const float found = walkPdf * (0.25f * InvPi * vertex.walkGeometry + candidateDensity(vertex.glossy.areaPdf));
        const float candidates = candidates_ * vertex.density;
        return maxComponent(vertex.power) * walkPdf * candidates / (candidates + found);
    };
    const auto choice = window_.choose(position, low, high, u, importance);
    if (!choice) return {};
    const float each = float(vertices_.size()) / (float(paths_) * float(ArrivalWindow::Size));
    return {&vertices_[choice->index], each * choice->inverseProbability};
}

} // namespace tungsten::path
