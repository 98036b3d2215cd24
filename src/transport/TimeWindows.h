#pragma once
// When light arrives, cut into windows: a guided path aims at one of them, and counts there alone (docs/method.md,
// section 11).

#include "tungsten/integrator/SceneFacts.h"
#include "tungsten/scene/Scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tungsten::transport {

/// Times of arrival, half open.
struct TimeWindow {
    double begin = 0.0, end = 0.0;
    float probability = 1.0f; ///< that a guided path aims at it; 1: there is no other

    [[nodiscard]] bool contains(double time) const { return probability == 1.0f || (time >= begin && time < end); }
};

/// Windows that share a gate. A path X that arrives in window i is found by guided paths with the density P_i lambda_i,
/// lambda_i being that of those that aim at it: whatever the windows, f / (P_i lambda_i) is an estimate, and so is the
/// balance with plain paths.
class TimeWindows {
  public:
    /// The whole gate.
    explicit TimeWindows(const TimeGate& arrivals) : windows_{{arrivals.start, arrivals.end(), 1.0f}} {}
    /// Windows for what is recorded in a sequence of frames: they grow with the time since the first light started.
    static TimeWindows ofSequence(const Scene& scene, const SceneFacts& facts, const TimeGate& arrivals);

    [[nodiscard]] size_t size() const { return windows_.size(); }
    [[nodiscard]] const TimeWindow& operator[](size_t index) const { return windows_[index]; }
    /// Index of the window that a time in the gate falls in.
    [[nodiscard]] size_t indexOf(double time) const {
        const auto after = [](double t, const TimeWindow& window) { return t < window.begin; };
        const auto next = std::upper_bound(windows_.begin() + 1, windows_.end(), time, after);
        return size_t(next - windows_.begin()) - 1;
    }
    /// `u` in [0, 1) chooses.
    [[nodiscard]] size_t choose(float u) const {
        return std::min(size_t(std::max(u, 0.0f) * float(windows_.size())), windows_.size() - 1);
    }

    [[nodiscard]] bool several() const { return windows_.size() > 1; }

  private:
    std::vector<TimeWindow> windows_;
};

} // namespace tungsten::transport
