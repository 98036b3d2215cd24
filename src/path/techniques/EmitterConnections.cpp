#include "path/techniques/EmitterConnections.h"

#include "path/techniques/LightVertexConnections.h"
#include "path/techniques/ReflectedConnections.h"

#include "transport/Balance.h"

namespace tungsten::path {

namespace {

/// The part of a connection from the surface at the end of the ray that is not left to light vertices and reflected
/// light.
float shareOfWalk(const GuidedPath& path, const SurfaceInteraction& surface, const Straight& way) {
    const Vec3f toVertex = -path.state.ray.direction;
    if (path.last.caches == LastVertex::Caches::None || !mayBeLightVertex(surface, toVertex, way.direction))
        return 1.0f;
    const PathTarget& target = *path.target;
    const float lightCosine = std::abs(way.direction.dot(surface.hit.ng));
    const float areaPdf =
        pdfEmissionDirection(*target.emitter, target.point, -way.direction) * lightCosine / sqr(way.distance);
    return transport::balance(
        ConnectionsFromSurfaces::density(path, surface.hit), LightVertexConnections::density(areaPdf),
        ReflectedConnections::density(path, surface, toVertex, surface.hit.t, way.direction, areaPdf));
}

} // namespace

void ConnectionsFromMedia::connect(GuidedPath& path, const Medium& medium, float controlShare) {
    CameraPath& state = path.state;
    if (path.step.residual().exit.sealed) return;
    if (controlShare == 1.0f && path.context.bound.oneSpeed()) return; // control vertices find it
    const Straight way = path.straightFrom(state.ray.origin);
    ++state.counters.connections;
    if (!path.mayConnect(state.time, way.distance)) return;
    const Rgb light = path.target->intensity(-way.direction);
    if (isBlack(light)) return;
    const Visibility visibility = path.traceToTarget({state.ray.origin, way.direction}, way, state.region);
    if (isBlack(visibility.transmittance) || !path.counts(visibility.crossings, 0)) return;
    const float share = visibility.oneSpeed ? 1.0f - controlShare : 1.0f;
    if (!(share > 0.0f)) return;
    const float phase = medium.phase.eval(state.ray.direction, way.direction);
    state.sink.add(state.throughput * light * visibility.transmittance * (phase / sqr(way.distance) * share),
                   state.time + visibility.time + path.target->start);
}

void ConnectionsFromSurfaces::connect(GuidedPath& path, const SurfaceHit& hit, const Rgb& throughput) {
    CameraPath& state = path.state;
    const PathTarget& target = *path.target;
    const Straight way = path.straightFrom(hit.position);
    ++state.counters.connections;
    const double time = state.timeAfter(hit.t);
    if (!path.mayConnect(time, way.distance)) return;
    const SurfaceInteraction surface = makeInteraction(path.scene(), hit, state.ray.direction);
    if (!surface.consistent(way.direction, path.scene().transport.consistencyChecks)) return;
    const Vec3f wo = surface.frame.toLocal(way.direction);
    const Rgb scattering = surface.bsdf->eval(surface.query(TransportMode::Radiance, lobe::Smooth), surface.wi, wo);
    if (isBlack(scattering)) return;
    const Rgb light = target.intensity(-way.direction);
    if (isBlack(light)) return;
    const Region region = regionBeyond(surface, way.direction, state.region);
    const Visibility visibility = path.traceToTarget(hit.leave(way.direction), way, region);
    if (isBlack(visibility.transmittance) || !path.counts(1 + visibility.crossings, 0)) return;
    // Weights by the surface's own density, which, unlike the guided one, is a function of the path alone.
    const float lightPdf = target.pdfFrom(hit.position, target.point.position, target.point.normal);
    const float bsdfPdf = surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi, wo);
    float weight = lightPdf > 0.0f ? transport::powerHeuristic(lightPdf, bsdfPdf) : 1.0f;
    if (visibility.crossings == 0) weight *= shareOfWalk(path, surface, way);
    state.sink.add(throughput * scattering * light * visibility.transmittance * (weight / sqr(way.distance)),
                   time + visibility.time + target.start);
}

float ConnectionsFromSurfaces::density(const GuidedPath& path, const SurfaceHit& hit) {
    return path.last.pdf * std::abs(path.state.ray.direction.dot(hit.ng)) / sqr(hit.t);
}

void EmittersMet::add(GuidedPath& path, const SurfaceHit& hit, const Rgb& throughput) {
    const PathTarget& target = *path.target;
    if (target.index < 0 || path.scene().primitives[hit.shape].emitter != target.index) return;
    if (path.last.kind == LastVertex::Kind::Medium || !path.counts(0, 0)) return; // connections from media find it
    const Rgb radiance = emittedRadiance(*target.emitter, hit.uv, hit.ng, -path.state.ray.direction);
    if (isBlack(radiance)) return;
    float weight = 1.0f;
    if (path.last.kind == LastVertex::Kind::Surface)
        weight = transport::powerHeuristic(density(path), target.pdfFrom(path.last.position, hit.position, hit.ng));
    path.state.sink.add(throughput * radiance * (weight / target.probability),
                        path.state.timeAfter(hit.t) + target.start);
}

} // namespace tungsten::path
