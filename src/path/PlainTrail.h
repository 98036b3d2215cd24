#pragma once
// How densely guided paths find what a plain path finds: asked of the guided steps, along the way that the plain one
// took.

#include "path/GuidedPath.h"

namespace tungsten::path {

/// What a plain path has passed, from where densities have been asked for last. They are only where it finds light in
/// time: the guided steps then go the same way, with the throughput that a guided path would have, up to there. Memory
/// is kept from path to path.
class PlainTrail {
  public:
    /// A new path, towards a target; `counters` of what densities cost.
    void start(const GuidedContext& context, PixelSink& sink, PathCounters& counters, const PathTarget& target) {
        steps_.clear();
        guided_.emplace(context, counters, target);
        context_ = &context;
        sink_ = &sink;
        counters_ = &counters;
        behind_ = {};
        next_ = 0;
        logRatio_ = 0.0f;
        alive_ = true;
    }

    // What the path does, in order.
    void fly(const PathState& start, const transport::Ahead& ahead) {
        steps_.push_back({.start = start, .hit = ahead.hit});
    }
    void arrive(const PathState& at, const transport::Ahead& ahead, const transport::Flight& flight) {
        Step& step = steps_.back();
        step.at = at;
        step.flight = flight;
        step.hit = ahead.hit;
        step.medium = flight.event == transport::Flight::Event::Collision ? ahead.medium : nullptr;
    }
    void leave(const transport::Way& way) { steps_.back().way = way; }

    // Logarithms of densities, guided over plain, of paths that end in light.
    /// With the vertex at which the path is. `open`: no boundary is crossed on the way to the target, so that light
    /// paths may find the same.
    [[nodiscard]] float atVertex(bool open) {
        const Step& step = at(steps_.size() - 1);
        return open ? step.openEnding : step.ending;
    }
    /// Of the way up to there, once one of the others has been asked.
    [[nodiscard]] float there() const { return steps_.back().there; }
    /// With light that the flight at hand has met.
    [[nodiscard]] float atLight() { return at(steps_.size() - 1).light; }

  private:
    struct Step {
        PathState start; ///< where the flight begins
        std::optional<SurfaceHit> hit{};
        PathState at{Sampler(0, RandomStream::Camera, 0, 0)}; ///< at its end
        transport::Flight flight{};
        const Medium* medium = nullptr; ///< where it scatters; null on surfaces
        std::optional<transport::Way> way{};
        // Logarithms, once they are known.
        float ending = 0.0f, openEnding = 0.0f; ///< of paths whose last vertex is this one
        float light = 0.0f;                     ///< of those that meet light here
        float there = 0.0f;                     ///< of the way up to here
    };

    /// The step, followed.
    const Step& at(size_t step);
    /// Of paths whose last vertex is the surface that ends this step, and which light paths may find.
    float byLightPaths(const Step& step);
    /// Follows a flight, from the end of the one before.
    void follow(size_t index);
    /// The guided steps do what guided paths do at the vertex that ends the step, and leave it.
    void pass(const Step& step);

    std::vector<Step> steps_;
    size_t next_ = 0;                      ///< flight that has not been followed yet
    std::optional<StepsToEmitter> guided_; ///< at the flight before
    const GuidedContext* context_ = nullptr;
    PixelSink* sink_ = nullptr;
    PathCounters* counters_ = nullptr;
    WayBehind behind_;      ///< of the vertex where that flight begins
    float logRatio_ = 0.0f; ///< at the end of that flight
    bool alive_ = true;     ///< guided paths may come there
};

} // namespace tungsten::path
