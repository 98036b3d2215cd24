#pragma once
// What plain walks from a light do on their way: every vertex is connected to the camera. Directions that they take to
// a detector count, too: both ways to find a path share it by the balance heuristic.

#include "transport/GateBounds.h"
#include "transport/PlainSteps.h"
#include "transport/TimeSensor.h"
#include "transport/Vertex.h"

namespace tungsten::path {

using transport::PathState;

/// A contribution to any place of the image.
struct Splat {
    Vec2f raster; ///< in pixels; whole numbers are pixels' centres
    int32_t frame;
    Rgb radiance;
};

/// What a walk needs to know; shared by all threads.
struct LightContext {
    const Scene& scene;
    const transport::BounceLimits& limits;
    const transport::TimeSensor& sensor;
    const transport::GateBounds& bounds;
    const Distribution1D& emitters;
    transport::Connector connector;
    bool russianRoulette;
    bool splits; ///< paths on their way to detectors (StepsToDetectors)
    const ProgressToken& watch;
};

/// What happened, counted by one worker.
struct LightCounters : transport::StepCounters {
    uint64_t shadowRays = 0, connections = 0, nonFinite = 0;
    uint64_t timed = 0, laterFrames = 0, weighed = 0; ///< of what arrives, timed: at a sensor that is not always open
};

/// Throughputs of its walks are relative to the power at their start, as their roulette wants them.
class CameraConnections : public transport::VisitorBase {
  public:
    CameraConnections(const LightContext& context, std::vector<Splat>& splats, LightCounters& counters)
        : context_(&context), splats_(&splats), counters_(&counters) {}

    /// Starts a path, and shows the camera a point of the light. False if no power leaves it.
    bool emit(PathState& path);

    /// The last vertex needs no way on.
    [[nodiscard]] bool mayGoOn(const PathState& path) const { return context_->limits.mayGoOn(path.interactions + 1); }
    bool arrive(PathState& path, auto& steps, const transport::Ahead& ahead, const transport::Flight& flight);
    bool vertex(PathState& path, auto& steps, const transport::WalkVertex& vertex);
    void leave(PathState& path, auto& steps, const transport::WalkVertex& vertex, const transport::Way& way);

  private:
    [[nodiscard]] const Scene& scene() const { return context_->scene; }
    [[nodiscard]] bool orderCounts(const PathState& path) const {
        return context_->limits.orderCounts(path.mediumScatters, inARow_);
    }
    /// A point of the emitter, as the camera sees it.
    void showEmitter(PathState& path, const Emitter& emitter, float probability);
    /// The environment, as a detector sees it straight.
    void showEnvironment(PathState& path, const Emitter& emitter, float probability);
    /// `mayMeet`: directions of the walk may find the same.
    void connect(PathState& path, const transport::Vertex& vertex, const Rgb& power, bool mayMeet);
    /// The ray may meet detectors. `pdf`: density of its direction per solid angle; 0 where no connection stands for
    /// it.
    void meetDetectors(const PathState& path, const Ray& ray, const Region& region, const Rgb& power, float pdf);
    /// What a connection brings to one place of the image. `scattered`: when camera segments began.
    void arriveAtSensor(const PathState& path, const Vec2f& raster, const transport::Connection& connection,
                        double scattered);
    [[nodiscard]] bool inView(const Vec2f& raster) const;

    const LightContext* context_;
    std::vector<Splat>* splats_;
    LightCounters* counters_;
    Rgb power_{0.0f};        ///< at the start
    double scattered_ = 0.0; ///< the time at the last vertex that is not specular: where camera segments begin
    int inARow_ = 0;         ///< PathState::inARow at the last scattering in a medium, surfaces since left out
};

/// Traces one path from a light.
void traceLightPath(const LightContext& context, const Sampler& sampler, std::vector<Splat>& splats,
                    LightCounters& counters);

} // namespace tungsten::path
