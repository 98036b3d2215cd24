#include "path/techniques/EmitterConnections.h"

#include "path/techniques/GlossyLightVertices.h"
#include "path/techniques/LightVertices.h"

#include "transport/Balance.h"

namespace tungsten::path {

void ConnectionsFromMedia::connect(const GuidedPath& path, const Medium& medium,
                                   const StepsToEmitter::InMedium& ending) {
    PathState& state = path.state;
    if (path.steps.budget().escape.refractedOnly) return;
    const float controlShare = ending.shareOfControl();
    if (controlShare == 1.0f && path.context.bound.oneSpeed()) return; // control vertices find it
    ++path.counters.connections;
    const auto way = path.wayInTime(state.ray.origin, state.time);
    if (!way) return;
    const transport::Vertex vertex(medium, state.ray.origin, state.ray.direction, state.region);
    const auto connection = path.connector().connect(
        vertex, state.throughput, transport::connectionEndpoint(*way, path.target()), path.counters.shadowRays);
    if (!connection || !path.counts(connection->crossings, 0)) return;
    const auto ofConnection = ConnectionsFromMedia::share(path, state.ray.origin, vertex.pdf(way->direction), ending);
    const float share = (connection->oneSpeed ? 1.0f - controlShare : 1.0f) * ofConnection.beside;
    if (share > 0.0f)
        path.sink.add(connection->throughput * share, state.time + connection->time + path.target().start,
                      *path.target().emitter, LogRatio(ending.logRatio).with(ofConnection), Found::OnWay);
}

transport::TechniqueShare ConnectionsFromMedia::share(const GuidedPath& path, const Vec3f& position, float pdf,
                                                      const StepsToEmitter::InMedium& ending) {
    if (!path.steps.hasDensities() || path.target().emitter->isDelta()) return {};
    return path.target().shareOfConnection(position, pdf, path.steps.connectionsOverPlain(ending.logRatio));
}

void ConnectionsFromSurfaces::connect(const GuidedPath& path, const SurfaceHit& hit, const Rgb& throughput) {
    PathState& state = path.state;
    const PathTarget& target = path.target();
    ++path.counters.connections;
    const double time = state.timeAfter(hit.t);
    const auto way = path.wayInTime(hit.position, time);
    if (!way) return;
    const transport::Vertex vertex = path.vertexOn(makeInteraction(path.scene(), hit, state.ray.direction));
    const auto connection = path.connector().connect(vertex, throughput, transport::connectionEndpoint(*way, target),
                                                     path.counters.shadowRays);
    if (!connection || !path.counts(1 + connection->crossings, 0)) return;
    // Weights by the surface's own density, which, unlike the guided one, is a function of the path alone.
    const auto ofConnection = target.shareOfConnection(hit.position, vertex.pdf(way->direction));
    const float share = connection->crossings == 0 ? shareOfWalk(path, vertex, hit.t, *way) : 1.0f;
    LogRatio logRatio = path.steps.logRatioOnSurface();
    if (share < 1.0f)
        logRatio = {path.logRatioByLightCaches(vertex, share), logRatio.weighed - std::log(std::max(share, 1e-30f))};
    path.sink.add(connection->throughput * (ofConnection.beside * share), time + connection->time + target.start,
                  *target.emitter, logRatio.with(ofConnection));
}

float ConnectionsFromSurfaces::shareOfWalk(const GuidedPath& path, const transport::Vertex& vertex, float length,
                                           const transport::Segment& way) {
    if (path.behind.caches == Caches::None || !holdsLightVertices(vertex.lobes()) || !vertex.reflects(way.direction))
        return 1.0f;
    const Vec3f& direction = path.state.ray.direction;
    const float areaPdf = vertex.areaDensity(path.target().vertex.pdf(-way.direction), way.direction, way.distance);
    float reflected = 0.0f;
    if (GlossyVertexConnections::mayFind(path, vertex))
        reflected =
            GlossyVertexConnections::density(path, vertex.pdfReverse(way.direction), {direction, length}, areaPdf);
    return transport::balance(density(path, vertex, length), LightVertexConnections::density(areaPdf), reflected);
}

float ConnectionsFromSurfaces::density(const GuidedPath& path, const transport::Vertex& vertex, float length) {
    return vertex.areaDensity(path.state.last.pdf, path.state.ray.direction, length);
}

void EmittersMet::add(const GuidedPath& path, const SurfaceHit& hit, const Rgb& throughput) {
    const PathTarget& target = path.target();
    if (target.index < 0 || path.scene().primitives[hit.shape].emitter != target.index) return;
    using Kind = transport::LastVertex::Kind;
    if (path.state.last.kind == Kind::Medium || !path.counts(0, 0)) return;
    const Rgb radiance = emittedRadiance(*target.emitter, hit.uv, hit.ng, -path.state.ray.direction);
    if (isBlack(radiance)) return;
    transport::TechniqueShare share;
    if (path.state.last.kind == Kind::Surface) {
        const transport::TechniqueShare::Densities densities{
            density(path), target.pdfFrom(path.state.last.position, hit.position, hit.ng)};
        share = transport::TechniqueShare::of(densities, densities);
    }
    const LogRatio logRatio = path.steps.logRatioOnSurface() + std::log(target.choice.ofPath);
    path.sink.add(throughput * radiance * (share.beside / target.choice.ofPath),
                  path.state.timeAfter(hit.t) + target.start, *target.emitter, logRatio.with(share));
}

} // namespace tungsten::path
