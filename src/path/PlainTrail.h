#pragma once
// How densely guided paths find what a plain path finds: asked of the guided steps, along the way that the plain one
// took.

#include "path/GuidedPath.h"

#include "transport/WalkRecord.h"

#include <deque>

namespace tungsten::path {

/// What a plain path has passed, and the targets that its vertices connect to: one of each emitter, drawn when it is
/// asked for first. Densities are only asked for where the path finds light in time: the guided steps towards the
/// light's target then go the same way, with the throughput that a guided path would have, from where they were led
/// last. Memory is kept from path to path.
class PlainTrail {
  public:
    /// A new path; `counters` of what densities cost, `light` of the targets.
    void start(const GuidedContext& context, const TargetChoice& targets, PixelAccumulator& sink,
               PathCounters& counters, const Sampler& light);

    // What the path does, in order.
    void fly(const PathState& start, const transport::Ahead& ahead) { record_.fly(start, ahead); }
    void arrive(const PathState& at, const transport::Ahead& ahead, const transport::Flight& flight) {
        record_.arrive(at, ahead, flight);
    }
    void leave(const transport::Way& way) { record_.leave(way); }

    [[nodiscard]] const TargetChoice& targets() const { return *targets_; }
    /// The path's point of an emitter that is a target of guided paths; null if its light gets nowhere.
    [[nodiscard]] const PathTarget* target(size_t emitter) {
        const auto& steps = follower(emitter, 0).steps;
        return steps ? &steps->target() : nullptr;
    }

    // Logarithms of densities, guided over plain, of paths that end in light of an emitter with a target, and arrive at
    // this time.
    /// With the vertex at which the path is. `open`: no boundary is crossed on the way to the target, so that light
    /// paths may find the same.
    [[nodiscard]] float atVertex(size_t emitter, double time, bool open) {
        const size_t window = context_->windows.indexOf(time);
        const Logs& logs = now(emitter, window);
        return (open ? logs.openEnding : logs.ending) + logOf(window);
    }
    /// How densely both strategies connect that vertex, in a medium, over plain paths alone.
    [[nodiscard]] float connectionsOverPlain(size_t emitter, double time) {
        const size_t window = context_->windows.indexOf(time);
        const float logRatio = now(emitter, window).ending;
        return follower(emitter, window).steps->connectionsOverPlain(logRatio);
    }
    /// And the last one in a medium, to the point of an emitter that has been met straight on from there.
    [[nodiscard]] float connectionsOverPlain(size_t emitter, const SurfaceHit& met, double time);
    /// Logarithm for the way up to there, of paths that aim at the first window.
    [[nodiscard]] float there(size_t emitter) { return now(emitter, 0).there; }
    /// With light that the flight at hand has met: guided paths count it if it is their target's.
    [[nodiscard]] float atLight(size_t emitter, double time) {
        const size_t window = context_->windows.indexOf(time);
        return now(emitter, window).light + logOf(window) + std::log(targets_->probability(emitter));
    }

  private:
    using Step = transport::WalkRecord::Step;
    struct Logs {
        float ending, openEnding; ///< of paths whose last vertex is that at the end of a step
        float light;              ///< of those that meet light there
        float there;              ///< of the way up to there
    };
    /// Guided steps towards one target, in one window.
    struct Follower {
        size_t slot = 0;
        std::optional<StepsToEmitter> steps; ///< at the flight that has been followed last; none: there is no target
        size_t next = 0;                     ///< flight that has not been followed yet
        WayBehind behind;                    ///< of the vertex where the last one begins
        float logRatio = 0.0f;               ///< at its end
        bool alive = true;                   ///< guided paths may come there
        Logs logs{};                         ///< of it
    };

    [[nodiscard]] Follower& follower(size_t emitter, size_t window);
    /// Up to the flight before this one.
    void followUntil(Follower& follower, size_t flights) {
        while (follower.next < flights) follow(follower, follower.next++);
    }
    /// Logarithms of the last step, after it has been followed.
    [[nodiscard]] const Logs& now(size_t emitter, size_t window);
    [[nodiscard]] float logOf(size_t window) const { return std::log(context_->windows[window].probability); }
    /// Logarithm for paths whose last vertex is the surface that ends this step, and which light caches may find.
    float byLightCaches(Follower& follower, const Step& step);
    /// Follows a flight, from the end of the one before.
    void follow(Follower& follower, size_t index);
    /// The guided steps do what guided paths do at the vertex that ends the step, and leave it.
    void pass(Follower& follower, const Step& step);

    transport::WalkRecord record_;
    std::deque<std::optional<Follower>> followers_; ///< the first `used_`, of this path
    size_t used_ = 0;
    std::vector<uint32_t> slots_; ///< by emitter and window: one above the follower's place, 0 if there is none
    const GuidedContext* context_ = nullptr;
    const TargetChoice* targets_ = nullptr;
    PixelAccumulator* sink_ = nullptr;
    PathCounters* counters_ = nullptr;
    std::optional<Sampler> light_;
};

} // namespace tungsten::path
