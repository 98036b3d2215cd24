#pragma once
// One path from a light, every vertex of which is connected to the camera.

#include "path/light/FilmSplats.h"
#include "transport/BounceLimits.h"
#include "transport/Connection.h"
#include "transport/GateBounds.h"
#include "transport/Sensor.h"
#include "transport/StepCounters.h"

namespace tungsten::path {

/// What a walk needs to know; shared by all threads.
struct LightWalkContext {
    const Scene& scene;
    const transport::BounceLimits& limits;
    const transport::Sensor& sensor;
    const transport::GateBounds& bounds;
    const Distribution1D& emitters;
    transport::Connector connector;
    bool russianRoulette;
    const PassWatch& watch;
};

/// What happened, counted by one worker.
struct LightWalkCounters : transport::StepCounters {
    uint64_t shadowRays = 0, connections = 0, nonFinite = 0;
    uint64_t timed = 0, laterFrames = 0, weighed = 0; ///< of what arrives, timed: at a sensor that is not always open
};

class LightWalk {
  public:
    LightWalk(const LightWalkContext& context, Sampler sampler, std::vector<Splat>& splats, LightWalkCounters& counters)
        : context_(context), scene_(context.scene), sampler_(sampler), splats_(splats), counters_(counters) {}

    void run();

  private:
    // False ends the path.
    bool emit();
    bool crossMedium(const Medium& medium);
    bool scatterInMedium(const Medium& medium, float distance);
    bool scatterOnSurface(const SurfaceHit& hit);
    /// Counts an interaction at the end of a flight, if light can still go on from there.
    bool arrive(const Vec3f& position, float length);
    bool continueRoulette();

    /// A point of the emitter, as the camera sees it.
    void showEmitter(const Emitter& emitter, float probability);
    /// The environment, as a detector sees it straight.
    void showEnvironment(const Emitter& emitter, float probability);
    void connect(const transport::Vertex& vertex, const Rgb& power);
    /// The ray ahead, which no connection stands for, may meet detectors.
    void meetDetectors();
    /// What a connection brings to one place of the image. `scattered`: when camera segments began.
    void arriveAtSensor(const Vec2f& raster, const transport::Connection& connection, double scattered);
    [[nodiscard]] bool inView(const Vec2f& raster) const;

    const LightWalkContext& context_;
    const Scene& scene_;
    Sampler sampler_;
    std::vector<Splat>& splats_;
    LightWalkCounters& counters_;

    Ray ray_;
    Region region_;
    Rgb power_{0.0f};        ///< at the start
    Rgb throughput_{1.0f};   ///< since then
    double time_ = 0.0;      ///< of flight, emission time included
    double scattered_ = 0.0; ///< the same at the last vertex that is not specular: where camera segments begin
    int interactions_ = 0;
    int flights_ = 0; ///< distances sampled in media since the last surface
    int mediumScatters_ = 0;
    int inARow_ = 0; ///< the last of these, without a surface between them
};

} // namespace tungsten::path
