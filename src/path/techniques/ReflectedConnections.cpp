#include "path/techniques/ReflectedConnections.h"

#include "path/techniques/LightPaths.h"
#include "path/techniques/LightVertexConnections.h"

#include "transport/Balance.h"

namespace tungsten::path {

namespace {

/// Where the reflected light ends, as a walk would meet it.
struct End {
    Scattering scattering; ///< towards the glossy surface
    float jacobian = 0.0f; ///< from densities per solid angle at the ray's origin to per area or volume here
    Region region;         ///< through which its light came
};

/// None where a walk would not go on like this.
std::optional<End> endOf(const GuidedPath& path, const ReflectedVertex& vertex, const Vec3f& direction,
                         float distance) {
    const Region& region = path.state.region;
    const float perVolume = 1.0f / sqr(distance);
    if (!vertex.surface) {
        const Medium& medium = *path.scene().medium(region);
        const float phase = medium.phase.eval(direction, vertex.toGlossy);
        return End{{medium.sigmaS() * phase, phase}, perVolume, region};
    }
    const SurfaceInteraction& there = *vertex.surface;
    if (!mayBeLightVertex(there, -direction, vertex.toGlossy) || !path.guideFor(there, -direction) ||
        !there.consistent(-direction, path.scene().transport.consistencyChecks))
        return std::nullopt;
    const Vec3f wi = there.frame.toLocal(-direction), wo = there.frame.toLocal(vertex.toGlossy);
    const BsdfQuery query = there.query(TransportMode::Radiance);
    return End{{there.bsdf->eval(query, wi, wo), there.bsdf->pdf(query, wi, wo)},
               perVolume * std::abs(direction.dot(there.hit.ng)),
               regionBeyond(there, -direction, region)};
}

/// Along the three straight parts from the ray's origin to the light.
Rgb transmittanceOf(const GuidedPath& path, const ReflectedVertex& vertex, const End& end, float distance) {
    const Scene& scene = path.scene();
    Rgb transmittance = scene.medium(path.state.region)->transmittance(distance);
    if (const Medium* between = scene.medium(end.region))
        transmittance = transmittance * between->transmittance(vertex.flight);
    if (const Medium* beyond = scene.medium(regionBeyond(vertex.glossy.surface, vertex.glossy.toLight, end.region)))
        transmittance = transmittance * beyond->transmittance(vertex.glossy.distance);
    return transmittance;
}

} // namespace

void ReflectedConnections::connect(GuidedPath& path, const SurfaceInteraction* surface,
                                   const ReflectedLightCache& cache) {
    CameraPath& state = path.state;
    const auto [low, high] = path.lengthsInGate();
    const ReflectedLightCache::Choice choice = cache.choose(state.ray.origin, low, high, state.sampler.next2D());
    if (!choice.vertex) return;
    const ReflectedVertex& vertex = *choice.vertex;
    if (!path.counts(2, vertex.surface ? 0 : 1)) return;
    const Vec3f offset = vertex.position - state.ray.origin;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return;
    const Vec3f direction = offset / distance;
    const Ray ray = path.leave(surface, direction,
                               vertex.surface ? vertex.surface->hit.margin().before(direction, distance) : distance);
    if (!(ray.tMin < ray.tMax)) return;
    const auto end = endOf(path, vertex, direction, distance);
    if (!end) return;
    const Scattering scattering = path.scatteringTowards(direction, surface);
    if (isBlack(scattering.value) || isBlack(end->scattering.value)) return;
    ++state.counters.shadowRays;
    ++state.counters.reflectedLight;
    if (path.scene().geometry->occluded(ray)) return;
    const float flight = vertex.surface ? 1.0f : path.context.lightPaths.flights().pdf(distance);
    // Of the walk and of light vertices one vertex on, together.
    const float walk =
        scattering.pdf * end->jacobian * flight *
        (end->scattering.pdf * vertex.walkGeometry + LightVertexConnections::density(vertex.glossy.areaPdf));
    const float share = transport::balance(cache.candidates() * vertex.density, walk);
    const Rgb transmittance = transmittanceOf(path, vertex, *end, distance);
    const double length = double(distance) + double(vertex.length), elapsed = state.time + path.target->start;
    state.sink.add(state.throughput * scattering.value * end->scattering.value * transmittance * vertex.power *
                       (end->jacobian * choice.weight * share),
                   elapsed + length / double(state.region.speed));
}

float ReflectedConnections::density(const GuidedPath& path, const SurfaceInteraction& glossy, const Vec3f& direction,
                                    float flight, const Vec3f& toLight, float areaPdf) {
    if (!path.approach || !reflectsSharply(*glossy.bsdf)) return 0.0f;
    const bool inMedium = isBlack(path.approach->normal);
    const float cosine = -direction.dot(path.approach->normal);
    if (!inMedium && !(cosine > 0.0f)) return 0.0f;
    const float pdf = glossy.bsdf->pdf(glossy.query(TransportMode::Radiance), glossy.frame.toLocal(toLight),
                                       glossy.frame.toLocal(direction));
    const LightPaths& lightPaths = path.context.lightPaths;
    const float end = inMedium ? lightPaths.flights().pdf(flight) : cosine;
    return lightPaths.reflected(path.target->index)->candidates() * areaPdf * pdf * end / sqr(flight) /
           path.approach->pdf;
}

} // namespace tungsten::path
