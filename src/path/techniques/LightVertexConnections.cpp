#include "path/techniques/LightVertexConnections.h"

#include "path/techniques/GlossyVertexConnections.h"

#include "transport/Balance.h"

namespace tungsten::path {

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
