#pragma once
// Light one reflection beyond a light vertex: where it goes from glossy surfaces. Paths from the camera seldom come
// upon the caustics that a glossy surface throws on what is close by; light's own paths go there. (Dragon: a
// quarter of the MSE at equal time.)

#include "path/techniques/LightVertices.h"

namespace tungsten::path {

/// The end of a light path emitter -> glossy surface -> here, no boundary between.
struct ReflectedVertex {
    Vec3f position;
    std::optional<SurfaceInteraction> surface; ///< seen from the glossy one; none in a medium
    Vec3f toGlossy;                            ///< unit
    float flight = 0.0f;                       ///< from the glossy surface
    float length = 0.0f;                       ///< of light's whole way
    Rgb power{0.0f};      ///< intensity x what the glossy surface scatters, over the density (transmittance and the
                          ///< cosine at the surface here left out)
    float density = 0.0f; ///< of the two last vertices: per area there, per area or volume here
    float walkGeometry = 0.0f; ///< |cosine at the glossy surface| / flight^2
    LightVertex glossy;
};

/// Free flights of light and walks, as weights take them: exponential, one rate for the whole scene.
struct Flights {
    float rate = 1.0f;
    [[nodiscard]] float sample(float u) const { return -std::log1p(-u) / rate; }
    [[nodiscard]] float pdf(float distance) const { return rate * std::exp(-rate * distance); }
};

/// Surfaces from which light is followed.
bool reflectsSharply(const Bsdf& bsdf);
/// Surfaces that light may be followed to: all lobes smooth, none transmits.
bool endsReflectedLight(const Bsdf& bsdf);

/// Reflected light of one emitter.
class ReflectedLightCache {
  public:
    struct Choice {
        const ReflectedVertex* vertex = nullptr;
        float weight = 0.0f; ///< 1 / (probability x number of light paths)
    };

    /// Learns from light paths of its own how many of them reflect.
    void prepare(const Scene& scene, const Emitter& emitter, const Flights& flights);
    /// No glossy surface in the light, none seen, or an emitter of a single direction.
    [[nodiscard]] bool empty() const { return !(candidates_ > 0.0f); }
    /// How many light paths are a vertex's candidates, on the average.
    [[nodiscard]] float candidates() const { return candidates_; }

    void trace(const Scene& scene, const Emitter& emitter, float probability, size_t paths, const PassInfo& pass,
               const Flights& flights);
    /// A candidate whose light, going on straight to `position`, arrives after a length in [low, high).
    [[nodiscard]] Choice choose(const Vec3f& position, float low, float high, const Vec2f& u) const;
    [[nodiscard]] const std::vector<ReflectedVertex>& vertices() const { return vertices_; }

  private:
    std::vector<ReflectedVertex> vertices_;
    ArrivalWindow window_;
    size_t paths_ = 0;
    float candidates_ = 0.0f;
};

} // namespace tungsten::path
