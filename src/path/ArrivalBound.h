#pragma once
// Bounds on when light can arrive: what they reject contributes to no frame.

#include "transport/GateBounds.h"

#include <vector>

namespace tungsten::path {

/// Exact culling by time of flight in a time-resolved render; the tests leave room for rounding at the gate's ends.
class ArrivalBound {
  public:
    ArrivalBound(const Scene& scene, const SceneFacts& facts);

    /// A camera path that took `time` from the sensor to `position` may still meet light inside the gate.
    [[nodiscard]] bool mayArrive(const Vec3f& position, double time) const;
    /// A straight connection of this length to an emitter whose pulse starts at `emissionTime` may fall into the gate.
    /// Where all speeds are equal its time is known, so that one that comes too early is rejected too.
    [[nodiscard]] bool mayConnect(double time, float distance, double emissionTime) const {
        return bounds_.mayArrive(time + emissionTime, double(distance));
    }
    /// Light that leaves a point at this distance at `emissionTime` may still arrive before the gate's end.
    [[nodiscard]] bool beforeEnd(double time, float distance, double emissionTime) const {
        return bounds_.beforeEnd(time + emissionTime, double(distance));
    }
    /// Highest speed of light anywhere on a path.
    [[nodiscard]] float highestSpeed() const { return highestSpeed_; }
    [[nodiscard]] bool oneSpeed() const { return bounds_.oneSpeed(); }
    /// Some surface scatters, reflects or refracts: paths that come from there count lights that they meet.
    [[nodiscard]] bool surfacesTurn() const { return surfacesTurn_; }

  private:
    /// Emitters within `radius` of `centre` (rounding of coordinates included), the first pulse at `emissionTime`.
    struct Source {
        Vec3f centre;
        float radius;
        double emissionTime;
    };
    static Source sourceOf(const Emitter& emitter);
    static Source merged(const std::vector<Source>& sources);

    std::vector<Source> sources_; ///< a few: many emitters are merged into one
    transport::GateBounds bounds_;
    float highestSpeed_ = 1.0f;
    bool surfacesTurn_ = true;
};

} // namespace tungsten::path
