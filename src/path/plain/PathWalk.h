#pragma once
// One path from the camera: plain free flights and directions, connected to an emitter at every vertex.

#include "path/ArrivalBound.h"
#include "path/CameraPath.h"
#include "path/PathSettings.h"
#include "path/PathTarget.h"
#include "path/techniques/RefractedLight.h"
#include "transport/Connection.h"
#include "tungsten/scene/LightChoice.h"

namespace tungsten::path {

/// What a walk needs to know; shared by all threads.
struct WalkContext {
    const Scene& scene;
    const PathSettings& settings;
    const LightChoice& lights;
    const ArrivalBound& bound;
    const RefractedLight* refracted; ///< of scenes whose bodies are all sealed, or null
    bool forwardBoundaries;          ///< connections must look through index-matched surfaces
    const PassWatch& watch;
};

/// Traces one camera path and adds what it finds to the sink; light that starts in a single direction is found through
/// the virtual point source `source`, if there is one. The two flags choose a specialised loop: `TimeResolved`
/// off leaves out every clock, `Media` off every free flight.
template <bool TimeResolved, bool Media>
class PathWalk {
  public:
    PathWalk(const WalkContext& context, PixelSink& sink, PathCounters& counters, const Sampler& sampler,
             const PathTarget* source)
        : path_(context.scene, sink, counters, sampler), scene_(context.scene), settings_(context.settings),
          lights_(context.lights), bound_(context.bound), connector_(context.scene, context.forwardBoundaries),
          source_(source), refracted_(context.refracted), watch_(context.watch) {}

    void run(Ray ray);

  private:
    /// A connection to an emitter, before visibility.
    struct LightSample {
        const Emitter& emitter;
        DirectSample direct;
        float probability; ///< of choosing the emitter
    };

    /// The way out of a sealed body, from its last vertex, as long as it meets nothing but surfaces.
    struct WayOut {
        SealedVertex from;
        Vec3f direction;
        size_t face;
        float pdf; ///< of the direction, times the probability of the flight to the boundary
    };

    void goOn();
    // False ends the path.
    bool crossMedium(const Medium& medium);
    bool arriveAt(const std::optional<SurfaceHit>& hit);
    bool scatterInMedium(const Medium& medium, float distance);
    bool scatterOnSurface(const SurfaceHit& hit);
    void addEmission(const SurfaceHit& hit);
    void addEnvironment();
    /// None when the emitter cannot light the position, or not inside the gate.
    std::optional<LightSample> sampleLight(const Vec3f& position);
    /// Adds the light that connections of a vertex bring: to an emitter, and to the virtual source.
    void connect(const transport::Vertex& vertex) {
        if (orderCounts() && !refracted_) connectToLight(vertex); // else no vertex is both smooth and in the open
        if (source_) connectToSource(vertex);
    }
    void connectToLight(const transport::Vertex& vertex);
    void connectToSource(const transport::Vertex& vertex);
    // Sealed bodies.
    /// From the vertex: a walk that aims at an emitter through a face.
    void aimThroughWall(const Medium& medium);
    /// Of that walk, all of it.
    void follow(const RefractedLight::Drawn& drawn, const Medium& medium);
    /// At a surface that is left through this lobe: whether a way out of a body begins, or has ended.
    void passWall(const SurfaceHit& hit, LobeMask lobe);
    /// Of light of an emitter that is met: the part that is not left to the other way of finding the same path.
    [[nodiscard]] float refractedShare(int emitter) const;
    bool continueRoulette();
    void advanceClock(float length);
    /// Whether light found from `position` on can still arrive inside the gate.
    [[nodiscard]] bool tooLate(const Vec3f& position) const;
    [[nodiscard]] bool rendered(int interactions) const { return settings_.limits.renders(interactions); }
    /// Whether light found at the end of the current segment counts (low_order_scattering, include_surfaces).
    [[nodiscard]] bool orderCounts(int further = 0) const {
        return settings_.limits.orderCounts(path_.mediumScatters + further);
    }

    CameraPath path_;
    const Scene& scene_;
    const PathSettings& settings_;
    const LightChoice& lights_;
    const ArrivalBound& bound_;
    transport::Connector connector_;
    const PathTarget* source_;
    const RefractedLight* refracted_;
    const PassWatch& watch_;
    std::optional<SealedVertex> sealed_; ///< the ray's origin, if it is a vertex of a sealed body
    std::optional<WayOut> wayOut_;
    int aimedAt_ = -1;            ///< the emitter, of a walk that follows a drawn way out
    LobeMask onward_ = lobe::All; ///< at the next surface
    /// The last vertex that connected to emitters, for weighting emitters found by the walk itself; none while
    /// specular.
    bool weighted_ = false;
    float directionPdf_ = 0.0f;
    Vec3f vertex_;
};

} // namespace tungsten::path
