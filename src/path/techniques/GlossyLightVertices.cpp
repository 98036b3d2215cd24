#include "path/techniques/GlossyLightVertices.h"

#include "path/GuidedPath.h"

#include "path/Tuning.h"

namespace tungsten::path {

namespace {

constexpr uint32_t PilotPass = std::numeric_limits<uint32_t>::max();

/// Adds up to two ends of one light path: where it meets the next surface, and a point before.
void traceReflection(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice, const Flights& flights,
                     Sampler sampler, std::vector<GlossyLightVertex>& vertices) {
    const auto glossy = traceLightVertex(scene, emitter, choice, sampler);
    if (!glossy || !reflectsSharply(glossy->vertex.lobes())) return;
    const SurfaceInteraction& from = *glossy->vertex.surface();
    const Vec2f uDirection = sampler.next2D();
    const auto sample = from.bsdf->sample(from.query(TransportMode::Photons), from.wi, {uDirection, sampler.next1D()});
    if (!sample || (sample->lobe & lobe::Smooth) == 0) return;
    const Vec3f direction = from.frame.toWorld(sample->wo).normalized();
    const float pdf = glossy->vertex.pdf(direction);
    const Rgb reflected = glossy->weighedIntensity(direction);
    if (!(pdf > 0.0f) || isBlack(reflected)) return;
    const auto end = [&](float flight, float density) {
        return GlossyLightVertex{*glossy,
                                 {direction, flight},
                                 std::nullopt,
                                 reflected / pdf,
                                 glossy->areaPdf * pdf * density / sqr(flight),
                                 glossy->vertex.areaDensity(1.0f, direction, flight)};
    };
    const Ray onward = glossy->vertex.spawnRay(direction);
    const auto hit = scene.geometry->intersect(onward);
    const float flight = flights.sample(sampler.next1D()), density = flights.pdf(flight);
    if (flight > onward.tMin && density > 0.0f && (!hit || flight < hit->t)) {
        vertices.push_back(end(flight, density));
        vertices.back().power = reflected / (pdf * density);
    }
    if (!hit || !endsGlossySubpath(scene.bsdfOf(*hit).lobes())) return;
    const float incidence = std::abs(direction.dot(hit->ng));
    if (!(incidence > 0.0f)) return;
    vertices.push_back(end(hit->t, incidence));
    vertices.back().surface.emplace(scene, makeInteraction(scene, *hit, direction), direction, TransportMode::Photons,
                                    glossy->vertex.region());
    vertices.back().incidence = incidence;
}

} // namespace

bool reflectsSharply(LobeMask lobes) {
    return (lobes & lobe::GlossyReflection) != 0 && (lobes & lobe::AnyTransmission) == 0;
}

void GlossyVertexCache::prepare(const Scene& scene, const Emitter& emitter, const Flights& flights,
                                const ProgressToken& watch) {
    trace(scene, emitter, {}, tuning::MostPaths, PassInfo{.index = PilotPass, .watch = watch}, flights);
    candidates_ =
        vertices().empty() ? 0.0f : float(tuning::Candidates) * float(tuning::MostPaths) / float(vertices().size());
}

void GlossyVertexCache::trace(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice, size_t paths,
                              const PassInfo& pass, const Flights& flights) {
    const auto stream = uint64_t(&emitter - scene.emitters.data()) << 32;
    window_.fill(paths, "glossy light vertices", pass.watch, [&](size_t i, std::vector<GlossyLightVertex>& vertices) {
        const Sampler sampler(pass.seed, RandomStream::ReflectedLight, pass.index, stream | i);
        traceReflection(scene, emitter, choice, flights, sampler, vertices);
    });
}

auto GlossyVertexCache::choose(const Vec3f& position, float low, float high, const Vec2f& u) const -> CandidateSample {
    // Rough contributions, beside walks with even directions.
    const auto importance = [this](const GlossyLightVertex& vertex, const Vec3f& direction, float distance) {
        const float even = 0.25f * InvPi;
        const float walkPdf =
            vertex.surface ? vertex.surface->areaDensity(even, direction, distance) : even / sqr(distance);
        const float found = walkPdf * (even * vertex.perAreaAtGlossy + candidateDensity(vertex.glossy.areaPdf));
        const float candidates = candidates_ * vertex.density;
        return maxComponent(vertex.power) / vertex.incidence * walkPdf * candidates / (candidates + found);
    };
    return window_.choose(position, low, high, u, importance);
}

} // namespace tungsten::path
