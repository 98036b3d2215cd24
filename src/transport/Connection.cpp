#include "transport/Connection.h"

namespace tungsten::transport {

std::optional<ConnectionEnd> connectionEnd(const Vertex& from, const Vertex& to) {
    const Vec3f offset = to.position() - from.position();
    const float distance = offset.length();
    if (!(distance > 0.0f)) return std::nullopt;
    const Vec3f direction = offset / distance;
    return ConnectionEnd{direction, distance, to.scattering(-direction) / sqr(distance), to.margin()};
}

std::optional<Connection> Connector::connect(const Vertex& vertex, const Rgb& throughput, const ConnectionEnd& end,
                                             uint64_t& rays) const {
    const Rgb value = throughput * vertex.scattering(end.direction) * end.weight;
    if (isBlack(value)) return std::nullopt;
    Ray ray = vertex.leave(end.direction);
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
