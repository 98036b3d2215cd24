#include "path/techniques/LightVertexConnections.h"

#include "path/techniques/ReflectedConnections.h"

#include "transport/Balance.h"

namespace tungsten::path {

void LightVertexConnections::connect(GuidedPath& path, const SurfaceInteraction* surface,
                                     const LightVertexCache& cache) {
    CameraPath& state = path.state;
    if (!path.counts(1, 0)) return;
    const auto [low, high] = path.lengthsInGate();
    const LightVertexCache::Choice choice = cache.choose(state.ray.origin, low, high, state.sampler.next2D());
    if (!choice.vertex) return;
    const LightVertex& vertex = *choice.vertex;
    const SurfaceHit& there = vertex.surface.hit;
    const Vec3f offset = there.position - state.ray.origin;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return;
    const Vec3f direction = offset / distance;
    const Ray ray = path.leave(surface, direction, there.margin().before(direction, distance));
    if (!(ray.tMin < ray.tMax)) return;
    const Scattering scattering = path.scatteringTowards(direction, surface);
    const Rgb onward = vertex.scattered(-direction);
    if (isBlack(scattering.value) || isBlack(onward)) return;
    ++state.counters.shadowRays;
    ++state.counters.lightVertices;
    const Scene& scene = path.scene();
    if (scene.geometry->occluded(ray)) return;
    const float perArea = std::abs(direction.dot(there.ng)) / sqr(distance);
    const float own = density(vertex.areaPdf), walk = scattering.pdf * perArea;
    const float reflected =
        ReflectedConnections::density(path, vertex.surface, -direction, distance, vertex.toLight, vertex.areaPdf);
    const float share = transport::balance(own, walk, reflected);
    const Medium *medium = scene.medium(state.region),
                 *beyond = scene.medium(regionBeyond(vertex.surface, vertex.toLight, state.region));
    Rgb transmittance = medium ? medium->transmittance(distance) : Rgb(1.0f);
    if (beyond) transmittance = transmittance * beyond->transmittance(vertex.distance);
    const double length = double(distance) + double(vertex.distance), elapsed = state.time + path.target->start;
    state.sink.add(state.throughput * scattering.value * transmittance * onward * (perArea * choice.weight * share),
                   elapsed + length / double(state.region.speed));
}

} // namespace tungsten::path
