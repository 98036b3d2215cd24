#pragma once
// Where a path's contributions go: the frame their time falls in, averaged over the gate or weighted by the sensor's
// response.

#include "darts/TemporalResponse.h"

#include "tungsten/film/Film.h"
#include "tungsten/scene/Scene.h"

namespace tungsten::path {

/// What happened, counted by one worker.
struct PathCounters {
    uint64_t rays = 0, shadowRays = 0, paths = 0, mediumEvents = 0, surfaceEvents = 0, controlVertices = 0,
             lightVertices = 0, reflectedLight = 0, connections = 0, arrivals = 0, nonFinite = 0;
};

/// When the sensor is open, and how it weighs that time: evenly, or by a response whose support is the gate.
struct Sensor {
    TimeGate gate;
    const darts::TemporalResponse* response = nullptr;
};

/// Adds contributions to one pixel of the pass image.
class PixelSink {
  public:
    PixelSink(Film& film, const Sensor& sensor, int x, int y, uint32_t samples, PathCounters& counters)
        : film_(film), gate_(sensor.gate), response_(sensor.response), x_(x), y_(y),
          scale_(float(1.0 / (double(samples) * (evenly() ? gate_.frameWidth : 1.0)))), counters_(counters) {}

    /// `time` is the total time of flight, emission time included; ignored in steady state.
    void add(const Rgb& radiance, double time) {
        const int frame = gate_.steadyState ? 0 : gate_.frameOf(time);
        if (frame >= 0) put(radiance, time, frame);
    }
    /// The same for a time that was drawn inside the gate: rounding at its ends drops nothing, and a delta gate, which
    /// no time meets, takes it with weight 1.
    void addInside(const Rgb& radiance, double time) {
        put(radiance, time, gate_.frames > 1 ? gate_.nearestFrame(time) : 0);
    }

  private:
    [[nodiscard]] bool evenly() const { return !gate_.steadyState && !gate_.delta && !response_; }
    void put(const Rgb& radiance, double time, int frame) {
        if (!isFinite(radiance)) {
            ++counters_.nonFinite;
            return;
        }
        const float weight = response_ ? scale_ * float(response_->pdf(time)) : scale_;
        if (weight > 0.0f) ++counters_.arrivals;
        film_.passPixel(frame, x_, y_) += radiance * weight;
    }

    Film& film_;
    const TimeGate& gate_;
    const darts::TemporalResponse* response_;
    int x_, y_;
    float scale_;
    PathCounters& counters_;
};

} // namespace tungsten::path
