#pragma once
// One path from the camera: plain free flights and directions, connected to an emitter at every vertex.

#include "path/LightChoice.h"
#include "path/PathSettings.h"
#include "path/PixelSink.h"

#include "tungsten/scene/Interaction.h"

namespace tungsten::path {

/// What a walk needs to know; shared by all threads.
struct WalkContext {
    const Scene& scene;
    const PathSettings& settings;
    const LightChoice& lights;
};

/// Traces one camera path and adds what it finds to the sink. The two flags choose a specialised loop: `TimeResolved`
/// off leaves out every clock, `Media` off every free flight.
template <bool TimeResolved, bool Media>
class PathWalk {
  public:
    PathWalk(const WalkContext& context, PixelSink& sink, PathCounters& counters, Sampler sampler)
        : scene_(context.scene), settings_(context.settings), lights_(context.lights), sink_(sink), counters_(counters),
          sampler_(sampler) {}

    void run(Ray ray);

  private:
    /// False ends the path.
    bool scatterInMedium(const Medium& medium, float distance);
    bool scatterOnSurface(const SurfaceHit& hit);
    void addEmission(const SurfaceHit& hit);
    void addEnvironment();
    void connectFromMedium(const Medium& medium);
    void connectFromSurface(const SurfaceInteraction& surface);
    /// Adds light through a connection whose scattering value (cosine included) and density of the walk's own sampling
    /// are given.
    void addConnection(const Emitter& emitter, const DirectSample& light, float lightProbability, const Rgb& scattering,
                       float directionPdf, const Vec3f& origin, bool fromSurface, const Region& region);
    bool continueRoulette();
    void advanceClock(float length);
    [[nodiscard]] bool tooLate() const;
    [[nodiscard]] bool rendered(int interactions) const {
        return interactions >= scene_.transport.minBounces && interactions < scene_.transport.maxBounces;
    }
    /// Whether light found at the end of the current segment counts (low_order_scattering, include_surfaces).
    [[nodiscard]] bool orderCounts() const {
        if (mediumScatters_ == 0) return settings_.includeSurfaces;
        return settings_.lowOrderScattering || mediumScatters_ > 1;
    }

    const Scene& scene_;
    const PathSettings& settings_;
    const LightChoice& lights_;
    PixelSink& sink_;
    PathCounters& counters_;
    Sampler sampler_;

    Ray ray_;
    Region region_;
    Rgb throughput_{1.0f};
    double time_ = 0.0; ///< from the sensor so far
    int interactions_ = 0;
    int flights_ = 0; ///< distances sampled in media since the last surface
    int mediumScatters_ = 0;
    bool scattered_ = false; ///< a smooth vertex exists: the camera side of the path is over
    /// The last vertex that connected to emitters, for weighting emitters found by the walk itself; none while
    /// specular.
    bool weighted_ = false;
    float directionPdf_ = 0.0f;
    Vec3f vertex_;
};

} // namespace tungsten::path
