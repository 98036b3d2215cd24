#pragma once
// Whether light can still arrive while the sensor is open, before its exact time is known.

#include "tungsten/integrator/SceneFacts.h"

namespace tungsten::transport {

/// Relative to a time or length of flight: rounding of lengths in float. What passes the tests below is tested exactly
/// when its frame is found.
inline constexpr double FlightSlack = 1e-6;

/// Never rejects what arrives in the gate. In steady state everything passes.
class GateBounds {
  public:
    GateBounds() = default;
    GateBounds(const TimeGate& gate, const SceneFacts& facts)
        : limited_(!gate.steadyState), oneSpeed_(!facts.speedsDiffer), start_(gate.start), end_(gate.end()),
          slowness_(1.0 / double(facts.highestSpeed)) {}

    /// Bounds of the same scene with the sensor open at another time.
    [[nodiscard]] GateBounds during(const TimeGate& gate) const {
        GateBounds bounds = *this;
        bounds.limited_ = !gate.steadyState;
        bounds.start_ = gate.start;
        bounds.end_ = gate.end();
        return bounds;
    }
    /// When light that leaves at `time` is `distance` away, at the soonest.
    [[nodiscard]] double soonest(double time, double distance) const { return time + distance * slowness_; }
    /// Light that goes at least `distance` after `time` may arrive before the end.
    [[nodiscard]] bool beforeEnd(double time, double distance) const {
        const double arrival = soonest(time, distance);
        return !limited_ || arrival < end_ + FlightSlack * std::abs(arrival);
    }
    /// Light that goes straight for `distance` may arrive inside; at one speed its time is known.
    [[nodiscard]] bool mayArrive(double time, double distance) const {
        const double arrival = soonest(time, distance), slack = FlightSlack * std::abs(arrival);
        return !limited_ || (arrival < end_ + slack && (!oneSpeed_ || arrival >= start_ - slack));
    }
    [[nodiscard]] bool oneSpeed() const { return oneSpeed_; }

  private:
    bool limited_ = false, oneSpeed_ = false;
    double start_ = 0.0, end_ = 0.0;
    double slowness_ = 1.0; ///< 1 / highest speed
};

} // namespace tungsten::transport
