#pragma once
// The straight line between two points of a light path.

#include "transport/Vertex.h"

#include <optional>

namespace tungsten::transport {

/// Straight segment from one point to another.
struct Segment {
    Vec3f direction; ///< unit
    float distance;
};
/// None if both are at the same place.
inline std::optional<Segment> connectionSegment(const Vec3f& from, const Vec3f& to) {
    const Vec3f offset = to - from;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return std::nullopt;
    return Segment{offset / distance, distance};
}

/// What a vertex is connected to, as seen from there.
struct ConnectionEndpoint {
    Vec3f direction; ///< unit
    float distance;  ///< may be Infinity
    Rgb weight; ///< what it sends or takes along the line over squared distance and density; visibility not included
    SurfaceMargin margin{};
};
/// A point on an emitter.
inline ConnectionEndpoint connectionEndpoint(const DirectSample& light) {
    return {light.direction, light.distance, light.weight, light.margin};
}
/// A place on the camera's lens.
inline ConnectionEndpoint connectionEndpoint(const SensorSample& sensor) {
    return {sensor.direction, sensor.distance, Rgb(sensor.weight), {}};
}
/// A vertex at the end of the way.
ConnectionEndpoint connectionEndpoint(const Segment& way, const SubpathEnd& end);

struct Connection {
    Rgb throughput;       ///< of the path up to the vertex, times scattering there, the end's weight and transmittance
    double time = 0.0;    ///< of flight along it
    int crossings = 0;    ///< index-matched surfaces on it: each is an interaction
    bool oneSpeed = true; ///< light goes at the speed at the vertex all the way
};

/// Connects vertices. Without index-matched boundaries in the scene every surface is opaque: one ray, one region.
class Connector {
  public:
    Connector(const Scene& scene, bool forwardBoundaries) : scene_(scene), forwardBoundaries_(forwardBoundaries) {}

    /// `throughput` is the path's up to the vertex. None where nothing gets through. Adds the rays traced to `rays`;
    /// none is traced where nothing scatters that way.
    [[nodiscard]] std::optional<Connection> connect(const Vertex& vertex, const Rgb& throughput,
                                                    const ConnectionEndpoint& end, uint64_t& rays) const;
    /// Along a ray that starts in `region`; its limits as traceVisibility() has them.
    [[nodiscard]] Visibility visibility(const Ray& ray, float distance, const Region& region, uint64_t& rays) const;

  private:
    const Scene& scene_;
    bool forwardBoundaries_;
};

} // namespace tungsten::transport
