#pragma once
// Light one reflection beyond a light vertex: where it goes from glossy surfaces. Paths from the camera seldom come
// upon the caustics that a glossy surface throws on what is close by; light's own paths go there. (Dragon: a
// quarter of the MSE at equal time.)

#include "path/GuidedPath.h"
#include "path/techniques/LightVertices.h"

namespace tungsten::path {

/// The end of a light path emitter -> glossy surface -> here, no boundary between.
struct GlossyLightVertex {
    LightVertex glossy;
    transport::Segment flight;                ///< from the glossy surface to here
    std::optional<transport::Vertex> surface; ///< none in a medium, which is that of the camera's path
    Rgb power;             ///< of the path up to here: what the glossy surface scatters over the density of the flight,
                           ///< per solid angle and length (transmittance left out)
    float density;         ///< of the two last vertices: per area there, per area or volume here
    float perAreaAtGlossy; ///< density per area there, of 1 per solid angle from here
    float incidence = 1;   ///< |cos| of the flight and the geometric normal here; 1 in a medium

    [[nodiscard]] Vec3f position() const {
        return surface ? surface->position() : glossy.vertex.position() + flight.direction * flight.distance;
    }
    /// Length of light's whole way.
    [[nodiscard]] float length() const { return glossy.distance + flight.distance; }
    /// For a path from the camera that comes to here through `region`.
    [[nodiscard]] transport::SubpathEnd endIn(const Scene& scene, const Region& region) const {
        if (surface) return {*surface, power};
        return {{*scene.medium(region), position(), flight.direction, region}, power};
    }
};

/// Free flights of light and walks, as weights take them: exponential, one rate for the whole scene.
struct Flights {
    float rate = 1.0f;
    [[nodiscard]] float sample(float u) const { return -std::log1p(-u) / rate; }
    [[nodiscard]] float pdf(float distance) const { return rate * std::exp(-rate * distance); }
};

/// Surfaces from which light is followed.
bool reflectsSharply(LobeMask lobes);

/// Reflected light of one emitter.
class GlossyVertexCache {
  public:
    using CandidateSample = ArrivalCandidates<GlossyLightVertex>::CandidateSample;

    /// Learns from light paths of its own how many of them reflect.
    void prepare(const Scene& scene, const Emitter& emitter, const Flights& flights, const ProgressToken& watch);
    /// No glossy surface in the light, none seen, or an emitter of a single direction.
    [[nodiscard]] bool empty() const { return !(candidates_ > 0.0f); }
    /// How many light paths are a vertex's candidates, on the average.
    [[nodiscard]] float candidates() const { return candidates_; }

    void trace(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice, size_t paths,
               const PassInfo& pass, const Flights& flights);
    /// A candidate whose light, going on straight to `position`, arrives after a length in [low, high).
    [[nodiscard]] CandidateSample choose(const Vec3f& position, float low, float high, const Vec2f& u) const;
    [[nodiscard]] const std::vector<GlossyLightVertex>& vertices() const { return window_.ends(); }

  private:
    ArrivalCandidates<GlossyLightVertex> window_;
    float candidates_ = 0.0f;
};

/// Light that a glossy surface has reflected, connected to vertices of the walk.
struct GlossyVertexConnections {
    /// From the vertex at the ray's origin.
    static void connect(const GuidedPath& path, const transport::Vertex& here, const GlossyVertexCache& cache);
    /// Whether one vertex before reflected light was connected to that may have come by way of `glossy`.
    [[nodiscard]] static bool mayFind(const GuidedPath& path, const transport::Vertex& glossy) {
        return path.behind.approach && reflectsSharply(glossy.lobes());
    }
    /// Density of the reflected light that one vertex before was connected to (mayFind), at the ray's origin and at a
    /// light vertex of density `areaPdf` at the end of `way`, over the walk's density at the ray's origin. `pdf` is
    /// light's from there, per solid angle, back along `way`.
    [[nodiscard]] static float density(const GuidedPath& path, float pdf, const transport::Segment& way, float areaPdf);
};

} // namespace tungsten::path
