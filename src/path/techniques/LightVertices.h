#pragma once
// Surface points that light reaches first, shared by all paths of a pass, and their connections to vertices of walks.
// Few surfaces lie where a path of given length can end; of these points a vertex has many candidates, by distance
// alone, before it traces a single ray. (cbox, 128 x 128: a tenth of the variance at equal time.)

#include "path/GuidedPath.h"
#include "path/PathTarget.h"
#include "path/techniques/ArrivalCandidates.h"

namespace tungsten::path {

/// The first surface on a ray from an emitter, no boundary between.
/// Light has come to it through the emitter's region; transmittance is left out of its power.
struct LightVertex : transport::SubpathEnd {
    float distance;  ///< from the light
    float areaPdf;   ///< density per area of this point
    float lightPdf;  ///< density per solid angle of the emitter's point, as PathTarget::pdfFrom here; 0: points
    float incidence; ///< |cos| of light's direction and the geometric normal

    [[nodiscard]] Vec3f position() const { return vertex.position(); }
    [[nodiscard]] float length() const { return distance; }
    /// intensity(), weighed against emitters that a walk meets; none to the other side of the surface.
    [[nodiscard]] Rgb weighedIntensity(const Vec3f& direction) const;
};

/// Surfaces that may have light vertices: they scatter smoothly and transmit nothing.
bool holdsLightVertices(LobeMask lobes);
/// The light path `sampler` draws from the emitter, as far as its first surface; none where that is no light vertex.
std::optional<LightVertex> traceLightVertex(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice,
                                            Sampler& sampler);
/// Light vertices of one emitter.
class LightVertexCache {
  public:
    using CandidateSample = ArrivalCandidates<LightVertex>::CandidateSample;

    /// A candidate whose light, going on straight to `position`, arrives after a length in [low, high).
    [[nodiscard]] CandidateSample choose(const Vec3f& position, float low, float high, const Vec2f& u) const;

    void trace(const Scene& scene, const Emitter& emitter, const EmitterChoice& choice, size_t paths,
               const PassInfo& pass);

  private:
    ArrivalCandidates<LightVertex> window_;
};

/// Density per area at `vertex` of the candidates there.
inline float candidateDensity(float areaPdf) {
    return float(tuning::Candidates) * areaPdf;
}

/// Light by way of light vertices, connected to vertices of the walk.
struct LightVertexConnections {
    /// From the vertex at the ray's origin.
    static void connect(const GuidedPath& path, const transport::Vertex& here, const LightVertexCache& cache);
    /// Per area, of a surface point that light reaches with density `areaPdf`.
    [[nodiscard]] static float density(float areaPdf) { return candidateDensity(areaPdf); }
};

} // namespace tungsten::path
