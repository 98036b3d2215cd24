#pragma once
// Vertices of light paths that others are connected to, on lights, surfaces and in media, and the straight lines
// between them.

#include "tungsten/core/Overloaded.h"
#include "tungsten/scene/Interaction.h"

#include <optional>
#include <variant>

namespace tungsten::transport {

/// A point of an emitter, drawn by sampleEmissionPoint().
struct LightPoint {
    const Emitter* emitter;
    SurfaceSample point;
};
/// A surface that a path has met.
struct SurfacePoint {
    SurfaceInteraction surface;
    Vec3f before;           ///< direction of propagation up to here
    TransportMode mode;     ///< Photons: of a path from the light
    bool consistencyChecks; ///< drops directions on the wrong side of the geometric normal
};
/// Where a path scatters in a medium.
struct MediumPoint {
    Vec3f position;
    Vec3f before; ///< direction of propagation up to here
    const Medium* medium;
};

class Vertex {
  public:
    Vertex(const Scene& scene, const Emitter& emitter, const SurfaceSample& point)
        : point_(LightPoint{&emitter, point}), region_(scene.regionOf(emitter)) {}
    /// `before` is the direction of propagation up to here, the region the one that the path came through.
    Vertex(const Scene& scene, const SurfaceInteraction& surface, const Vec3f& before, TransportMode mode,
           const Region& region)
        : point_(SurfacePoint{surface, before, mode, scene.transport.consistencyChecks}), region_(region) {}
    Vertex(const Medium& medium, const Vec3f& position, const Vec3f& before, const Region& region)
        : point_(MediumPoint{position, before, &medium}), region_(region) {}

    [[nodiscard]] Vec3f position() const;
    /// Without extent in space.
    [[nodiscard]] SurfaceMargin margin() const;
    /// Null in media and on lights.
    [[nodiscard]] const SurfaceInteraction* surface() const;
    /// Lobes of the surface; none elsewhere.
    [[nodiscard]] LobeMask lobes() const { return surface() ? surface()->bsdf->lobes() : lobe::None; }
    /// Light leaves it in more than single directions.
    [[nodiscard]] bool isConnectible() const;
    /// Per steradian along the unit `direction`, away from here: emitted power; BSDF of the smooth lobes with the
    /// cosine (from the light: with the factor of shading normals); phase function.
    [[nodiscard]] Rgb scattering(const Vec3f& direction) const;
    /// `direction` is on the side of the surface that the path came from; anywhere else true.
    [[nodiscard]] bool reflects(const Vec3f& direction) const;
    /// Density per solid angle with which the path itself goes on, at lights starts, along `direction`.
    [[nodiscard]] float pdf(const Vec3f& direction) const;
    /// Density per solid angle with which a path of the other mode that comes from where `direction` leads goes on to
    /// where this one came from; 0 at lights, which nothing comes to.
    [[nodiscard]] float pdfReverse(const Vec3f& direction) const;
    /// Density per area (in media: per volume, collisions left out) at this point of a density per solid angle at a
    /// distance from here, seen along the unit `direction`.
    [[nodiscard]] float areaDensity(float pdfSolidAngle, const Vec3f& direction, float distance) const;
    /// A ray that does not meet the surface here.
    [[nodiscard]] Ray spawnRay(const Vec3f& direction) const;
    /// The one that the path came through, or the light's.
    [[nodiscard]] const Region& region() const { return region_; }
    /// The region along `direction`.
    [[nodiscard]] Region regionTowards(const Vec3f& direction) const { return regionTowards(direction, region_); }
    /// Region in a direction, for a path that came through `region`.
    [[nodiscard]] Region regionTowards(const Vec3f& direction, const Region& region) const;

  private:
    std::variant<LightPoint, SurfacePoint, MediumPoint> point_;
    Region region_;
};

/// The last vertex of light's path so far: what techniques draw, keep and connect to. Each adds what its own densities
/// need.
struct SubpathEnd {
    Vertex vertex;
    Rgb power; ///< of the path up to the vertex, over the densities with which it was drawn

    /// Power per steradian that leaves along the unit `direction`.
    [[nodiscard]] Rgb intensity(const Vec3f& direction) const { return power * vertex.scattering(direction); }
};

// Here, since techniques ask for these of every candidate.

inline Vec3f Vertex::position() const {
    return std::visit(Overloaded{[](const LightPoint& light) { return light.point.position; },
                                 [](const SurfacePoint& at) { return at.surface.hit.position; },
                                 [](const MediumPoint& at) { return at.position; }},
                      point_);
}

inline SurfaceMargin Vertex::margin() const {
    return std::visit(Overloaded{[](const LightPoint& light) { return light.point.margin(); },
                                 [](const SurfacePoint& at) { return at.surface.hit.margin(); },
                                 [](const MediumPoint&) { return SurfaceMargin{}; }},
                      point_);
}

inline float Vertex::areaDensity(float pdfSolidAngle, const Vec3f& direction, float distance) const {
    const float perArea = pdfSolidAngle / sqr(distance);
    return std::visit(
        Overloaded{[&](const LightPoint& light) {
                       return emittingArea(*light.emitter) > 0.0f
                                  ? perArea * std::abs(direction.dot(light.point.normal))
                                  : perArea;
                   },
                   [&](const SurfacePoint& at) { return perArea * std::abs(direction.dot(at.surface.hit.ng)); },
                   [&](const MediumPoint&) { return perArea; }},
        point_);
}

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
