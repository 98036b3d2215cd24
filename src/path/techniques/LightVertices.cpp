#include "path/techniques/LightVertices.h"

#include "path/techniques/GlossyLightVertices.h"

#include "transport/Balance.h"

namespace tungsten::path {

bool holdsLightVertices(LobeMask lobes) {
    return (lobes & lobe::Smooth) != 0 && (lobes & lobe::AnyTransmission) == 0;
}

std::optional<LightVertex> traceLightVertex(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice,
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
    return LightVertex{{vertex, emission.power / choice.ofPath},
                       hit->t,
                       vertex.areaDensity(emission.pdfDirection, direction, hit->t),
                       choice.ofVertex * pdfDirect(emitter, hit->position, emission.ray.origin, emission.normal),
                       incidence};
}

Rgb LightVertex::weighedIntensity(const Vec3f& direction) const {
    if (!vertex.reflects(direction)) return Rgb(0.0f);
    const Rgb value = intensity(direction);
    return lightPdf > 0.0f ? value * transport::powerHeuristic(lightPdf, vertex.pdfReverse(direction)) : value;
}

void LightVertexCache::trace(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice, size_t paths,
                             const PassInfo& pass) {
    const auto stream = uint64_t(&emitter - scene.emitters.data()) << 32;
    window_.fill(paths, "light paths", pass.watch, [&](size_t i, std::vector<LightVertex>& vertices) {
        Sampler sampler(pass.seed, RandomStream::LightVertex, pass.index, stream | i);
        if (auto vertex = traceLightVertex(scene, emitter, choice, sampler)) vertices.push_back(*vertex);
    });
}

auto LightVertexCache::choose(const Vec3f& position, float low, float high, const Vec2f& u) const -> CandidateSample {
    // Rough contributions, beside walks with even directions.
    const auto importance = [](const LightVertex& vertex, const Vec3f& direction, float distance) {
        const float walkPdf = vertex.vertex.areaDensity(0.25f * InvPi, direction, distance);
        const float candidates = candidateDensity(vertex.areaPdf);
        return maxComponent(vertex.power) / vertex.incidence * walkPdf * candidates / (candidates + walkPdf);
    };
    return window_.choose(position, low, high, u, importance);
}

// ---- Connections

void LightVertexConnections::connect(const GuidedPath& path, const transport::Vertex& here,
                                     const LightVertexCache& cache) {
    PathState& state = path.state;
    if (!path.counts(1, 0)) return;
    const auto [low, high] = path.lengthsInGate();
    state.random.at(state.interactions, Draw::LightVertex);
    const LightVertexCache::CandidateSample choice = cache.choose(here.position(), low, high, state.random.next2D());
    if (!choice.vertex) return;
    const LightVertex& light = *choice.vertex;
    const auto way = transport::connectionSegment(here.position(), light.vertex.position());
    if (!way) return;
    const auto& [direction, distance] = *way;
    const transport::ConnectionEndpoint end{direction, distance, light.weighedIntensity(-direction) / sqr(distance),
                                            light.vertex.margin()};
    ++path.counters.lightVertices;
    const auto connection = path.connectInRegion(here, end);
    if (!connection) return;
    const float walk = light.vertex.areaDensity(here.pdf(direction), direction, distance);
    float reflected = 0.0f;
    if (GlossyVertexConnections::mayFind(path, light.vertex))
        reflected = GlossyVertexConnections::density(path, light.vertex.pdf(-direction), *way, light.areaPdf);
    const float share = transport::balance(density(light.areaPdf), walk, reflected);
    const float ofWalk = transport::balance(walk, density(light.areaPdf), reflected);
    const float plain = walk * path.plainlyPasses(state.region, distance);
    const LogRatio logRatio{path.logRatioByLightCaches(light.vertex, ofWalk),
                            path.behind.ratios.there + std::log(light.areaPdf / (plain * choice.weight * share))};
    Rgb transmittance(1.0f);
    if (const Medium* beyond = path.scene().medium(light.vertex.regionTowards(-direction, state.region)))
        transmittance = beyond->transmittance(light.distance);
    const double time = connection->time + double(light.distance) / double(state.region.speed);
    path.sink.add(connection->throughput * transmittance * (choice.weight * share),
                  state.time + time + path.target().start, *path.target().emitter, logRatio);
}

} // namespace tungsten::path
