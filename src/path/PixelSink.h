#pragma once
// Where a path's contributions go: the frame their time falls in, averaged over the gate.

#include "tungsten/film/Film.h"
#include "tungsten/scene/Scene.h"

namespace tungsten::path {

/// What happened, counted by one worker.
struct PathCounters {
    uint64_t rays = 0, shadowRays = 0, paths = 0, mediumEvents = 0, surfaceEvents = 0, nonFinite = 0;
};

/// Adds contributions to one pixel of the pass image.
class PixelSink {
  public:
    PixelSink(Film& film, const TimeGate& gate, int x, int y, uint32_t samples, PathCounters& counters)
        : film_(film), gate_(gate), x_(x), y_(y),
          scale_(float(1.0 / (double(samples) * (gate.steadyState ? 1.0 : gate.frameWidth)))), counters_(counters) {}

    /// `time` is the total time of flight, emission time included; ignored in steady state.
    void add(const Rgb& radiance, double time) {
        const int frame = gate_.steadyState ? 0 : gate_.frameOf(time);
        if (frame < 0) return;
        if (!isFinite(radiance)) {
            ++counters_.nonFinite;
            return;
        }
        film_.passPixel(frame, x_, y_) += radiance * scale_;
    }

  private:
    Film& film_;
    const TimeGate& gate_;
    int x_, y_;
    float scale_;
    PathCounters& counters_;
};

} // namespace tungsten::path
