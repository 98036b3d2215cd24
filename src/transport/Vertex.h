#pragma once
// A point of a light path that others are connected to: on a light, a surface or in a medium.

#include "tungsten/scene/Interaction.h"

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
    /// Light leaves it in more than single directions.
    [[nodiscard]] bool isConnectible() const;
    /// Per steradian along the unit `direction`, away from here: emitted power; BSDF of the smooth lobes with the
    /// cosine (from the light: with the factor of shading normals); phase function.
    [[nodiscard]] Rgb scattering(const Vec3f& direction) const;
    /// Density per solid angle with which the path itself goes on along `direction`; 0 at lights, which start paths.
    [[nodiscard]] float pdf(const Vec3f& direction) const;
    /// Density per area (in media: per volume, collisions left out) at this point of a density per solid angle at a
    /// distance from here, seen along the unit `direction`.
    [[nodiscard]] float areaDensity(float pdfSolidAngle, const Vec3f& direction, float distance) const;
    /// A ray that does not meet the surface here.
    [[nodiscard]] Ray leave(const Vec3f& direction) const;
    /// The one that the path came through, or the light's.
    [[nodiscard]] const Region& region() const { return region_; }
    /// The region along `direction`.
    [[nodiscard]] Region regionTowards(const Vec3f& direction) const;

  private:
    std::variant<LightPoint, SurfacePoint, MediumPoint> point_;
    Region region_;
};

} // namespace tungsten::transport
