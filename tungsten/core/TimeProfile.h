#pragma once
// Densities over time: pulses of light, and what a sensor makes of a moment.

#include <vector>

namespace tungsten {

/// Linear between (times[i], values[i]), zero outside, in any scale: what it is used for counts its integral as 1.
struct TimeProfile {
    std::vector<double> times, values;
    [[nodiscard]] bool empty() const { return times.empty(); }
    friend bool operator==(const TimeProfile&, const TimeProfile&) = default;
};

} // namespace tungsten
