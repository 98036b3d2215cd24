#pragma once
// How long preparing and rendering may take, from when the session begins.

#include <algorithm>
#include <chrono>

namespace tungsten {

class TimeLimit {
  public:
    using Clock = std::chrono::steady_clock;

    /// 0 seconds: none.
    explicit TimeLimit(double seconds) : seconds_(seconds) {}

    [[nodiscard]] bool isOver() const { return seconds_ > 0.0 && Clock::now() >= end(); }
    [[nodiscard]] Clock::time_point end() const {
        return seconds_ > 0.0 ? after(begin_, seconds_) : Clock::time_point::max();
    }
    /// When a first pass that begins now, and that may be cut (PassSizes), is broken off.
    [[nodiscard]] Clock::time_point endOfFirstPass() const {
        return seconds_ > 0.0 ? std::min(end(), after(Clock::now(), firstPassSeconds())) : end();
    }
    [[nodiscard]] double firstPassSeconds() const { return FirstPassPart * seconds_; }

  private:
    static constexpr double FirstPassPart = 0.25;

    static Clock::time_point after(Clock::time_point start, double seconds) {
        constexpr double Ever = 1e9; // the clock counts nanoseconds in 64 bits
        return start +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, Ever)));
    }

    double seconds_;
    Clock::time_point begin_ = Clock::now();
};

} // namespace tungsten
