#include "transport/Connection.h"

namespace tungsten::transport {

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
