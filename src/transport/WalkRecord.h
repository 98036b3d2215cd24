#pragma once
// Where a walk went: flights and vertices, so that other steps can be asked afterwards how densely they go there.

#include "transport/Walk.h"

#include <vector>

namespace tungsten::transport {

class WalkRecord {
  public:
    struct Step {
        PathState start; ///< where the flight begins
        std::optional<SurfaceHit> hit{};
        PathState at{Sampler(0, RandomStream::Camera, 0, 0)}; ///< at its end
        Flight flight{};
        const Medium* medium = nullptr; ///< where it scatters; null on surfaces
        std::optional<Way> way{};       ///< that the walk has left by
    };

    void clear() { steps_.clear(); }
    // What the walk does, in order.
    void fly(const PathState& start, const Ahead& ahead) { steps_.push_back({.start = start, .hit = ahead.hit}); }
    void arrive(const PathState& at, const Ahead& ahead, const Flight& flight) {
        Step& step = steps_.back();
        step.at = at;
        step.flight = flight;
        step.hit = ahead.hit;
        step.medium = flight.event == Flight::Event::Collision ? ahead.medium : nullptr;
    }
    void leave(const Way& way) { steps_.back().way = way; }

    [[nodiscard]] size_t size() const { return steps_.size(); }
    [[nodiscard]] const Step& operator[](size_t index) const { return steps_[index]; }

    /// The throughput of the same path, found by guided steps; L is the logarithm of their density over the walk's.
    [[nodiscard]] static Rgb throughputOfGuided(const Rgb& plain, float logRatio) {
        return plain * std::exp(std::min(-logRatio, 80.0f));
    }

  private:
    std::vector<Step> steps_; ///< memory is kept from walk to walk
};

} // namespace tungsten::transport
