#include "transport/Vertex.h"

#include "tungsten/core/Overloaded.h"

namespace tungsten::transport {

const SurfaceInteraction* Vertex::surface() const {
    const auto* at = std::get_if<SurfacePoint>(&point_);
    return at ? &at->surface : nullptr;
}

bool Vertex::isConnectible() const {
    return std::visit(
        Overloaded{[](const LightPoint& light) { return !light.emitter->isDelta() && !light.emitter->isInfinite(); },
                   [](const SurfacePoint& at) { return (at.surface.bsdf->lobes() & lobe::Smooth) != 0; },
                   [](const MediumPoint&) { return true; }},
        point_);
}

Rgb Vertex::scattering(const Vec3f& direction) const {
    return std::visit(
        Overloaded{[&](const LightPoint& light) { return emittedIntensity(*light.emitter, light.point, direction); },
                   [&](const SurfacePoint& at) -> Rgb {
                       const SurfaceInteraction& surface = at.surface;
                       if (!surface.consistent(direction, at.consistencyChecks)) return Rgb(0.0f);
                       const Rgb value = surface.bsdf->eval(surface.query(at.mode, lobe::Smooth), surface.wi,
                                                            surface.frame.toLocal(direction));
                       if (at.mode == TransportMode::Radiance) return value;
                       return value * surface.photonShadingFactor(-at.before, direction);
                   },
                   [&](const MediumPoint& at) { return Rgb(at.medium->phase.eval(at.before, direction)); }},
        point_);
}

bool Vertex::reflects(const Vec3f& direction) const {
    return std::visit(Overloaded{[](const LightPoint&) { return true; },
                                 [&](const SurfacePoint& at) {
                                     const Vec3f& ng = at.surface.hit.ng;
                                     return direction.dot(ng) * at.before.dot(ng) < 0.0f;
                                 },
                                 [](const MediumPoint&) { return true; }},
                      point_);
}

float Vertex::pdf(const Vec3f& direction) const {
    return std::visit(Overloaded{[&](const LightPoint& light) {
                                     return pdfEmissionDirection(*light.emitter, light.point, direction);
                                 },
                                 [&](const SurfacePoint& at) {
                                     return at.surface.bsdf->pdf(at.surface.query(at.mode), at.surface.wi,
                                                                 at.surface.frame.toLocal(direction));
                                 },
                                 [&](const MediumPoint& at) { return at.medium->phase.pdf(at.before, direction); }},
                      point_);
}

float Vertex::pdfReverse(const Vec3f& direction) const {
    return std::visit(Overloaded{[](const LightPoint&) { return 0.0f; },
                                 [&](const SurfacePoint& at) {
                                     const TransportMode mode = at.mode == TransportMode::Photons
                                                                    ? TransportMode::Radiance
                                                                    : TransportMode::Photons;
                                     return at.surface.bsdf->pdf(at.surface.query(mode),
                                                                 at.surface.frame.toLocal(direction), at.surface.wi);
                                 },
                                 [&](const MediumPoint& at) { return at.medium->phase.pdf(-direction, -at.before); }},
                      point_);
}

Ray Vertex::spawnRay(const Vec3f& direction) const {
    return margin().spawnRay(position(), direction);
}

Region Vertex::regionTowards(const Vec3f& direction, const Region& region) const {
    return std::visit(Overloaded{[&](const LightPoint&) { return region; },
                                 [&](const SurfacePoint& at) { return regionBeyond(at.surface, direction, region); },
                                 [&](const MediumPoint&) { return region; }},
                      point_);
}

// ---- Connections

ConnectionEndpoint connectionEndpoint(const Segment& way, const SubpathEnd& end) {
    return {way.direction, way.distance, end.intensity(-way.direction) / sqr(way.distance), end.vertex.margin()};
}

std::optional<Connection> Connector::connect(const Vertex& vertex, const Rgb& throughput, const ConnectionEndpoint& end,
                                             uint64_t& rays) const {
    const Rgb value = throughput * vertex.scattering(end.direction) * end.weight;
    if (isBlack(value)) return std::nullopt;
    Ray ray = vertex.spawnRay(end.direction);
    ray.tMax = end.margin.before(end.direction, end.distance);
    const Visibility seen = visibility(ray, end.distance, vertex.regionTowards(end.direction), rays);
    if (isBlack(seen.transmittance)) return std::nullopt;
    return Connection{value * seen.transmittance, seen.time, seen.crossings, seen.oneSpeed};
}

Visibility Connector::visibility(const Ray& ray, float distance, const Region& region, uint64_t& rays) const {
    if (forwardBoundaries_) return traceVisibility(scene_, ray, distance, region, rays);
    ++rays;
    if (scene_.geometry->occluded(ray)) return {};
    const Medium* medium = scene_.medium(region);
    Visibility seen;
    seen.transmittance = medium ? medium->transmittance(distance) : Rgb(1.0f);
    seen.time = double(distance) / double(region.speed);
    return seen;
}

} // namespace tungsten::transport
