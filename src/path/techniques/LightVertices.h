#pragma once
// Surface points that light reaches first, shared by all paths of a pass. Few surfaces lie where a path of given length
// can end; of these points a vertex has many candidates, by distance alone, before it traces a single ray. (cbox, 128 x
// 128: a tenth of the variance at equal time.)

#include "path/PathTarget.h"
#include "path/techniques/ArrivalWindow.h"

#include "tungsten/render/Integrator.h"

#include <vector>

namespace tungsten::path {

/// The first surface on a ray from an emitter, no boundary between.
struct LightVertex {
    transport::Vertex vertex; ///< met by light, through the emitter's region
    Rgb power;       ///< intensity / (density of the direction x the emitter's probability), transmittance left out
    float distance;  ///< from the light
    float areaPdf;   ///< density per area of this point
    float lightPdf;  ///< density per solid angle of the emitter's point, chosen by area, seen from here; 0: points
    float incidence; ///< |cos| of light's direction and the geometric normal

    /// Power per steradian that leaves along the unit `direction`, weighed against emitters that a walk meets; none to
    /// the other side of the surface.
    [[nodiscard]] Rgb intensity(const Vec3f& direction) const;
};

/// Surfaces that may have light vertices: they scatter smoothly and transmit nothing.
bool holdsLightVertices(LobeMask lobes);
/// The light path `sampler` draws from the emitter, as far as its first surface; none where that is no light vertex.
std::optional<LightVertex> traceLightVertex(const Scene& scene, const Emitter& emitter, float probability,
                                            Sampler& sampler);
/// Light vertices of one emitter.
class LightVertexCache {
  public:
    /// How many a vertex tries.
    static constexpr size_t Candidates = ArrivalWindow::Size;

    struct Choice {
        const LightVertex* vertex = nullptr;
        float weight = 0.0f; ///< 1 / (probability x number of light paths)
    };
    /// One of Candidates vertices from a random place in the cache whose light, going on to `position` by a straight
    /// line, arrives there after a length in [low, high) from the emitter, if there is any.
    [[nodiscard]] Choice choose(const Vec3f& position, float low, float high, const Vec2f& u) const;

    void trace(const Scene& scene, const Emitter& emitter, float probability, size_t paths, const PassInfo& pass);
    [[nodiscard]] size_t paths() const { return paths_; }

  private:
    std::vector<LightVertex> vertices_;
    ArrivalWindow window_;
    size_t paths_ = 0;
};

/// Density per area at `vertex` of the candidates there.
inline float candidateDensity(float areaPdf) {
    return float(LightVertexCache::Candidates) * areaPdf;
}

} // namespace tungsten::path
