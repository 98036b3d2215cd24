#pragma once
// Where a path's contributions go: the frame their time falls in, weighed as the sensor does.

#include "transport/SharePilot.h"
#include "transport/StepCounters.h"
#include "transport/TimeSensor.h"
#include "transport/TimeWindows.h"

#include "tungsten/film/Film.h"

#include <array>
#include <bit>

namespace tungsten::path {

using transport::Found;
using transport::LogRatio;
using transport::PathCosts;
using transport::SharePilot;
using transport::Strategy;
using transport::StrategyBalance;

/// What happened, counted by one worker.
struct PathCounters : transport::StepCounters {
    uint64_t shadowRays = 0, paths = 0, controlVertices = 0, lightVertices = 0, reflectedLight = 0, refracted = 0,
             connections = 0, intoDetectors = 0, inView = 0, nonFinite = 0, densities = 0, plainPaths = 0;
    uint64_t arrivals = 0, timed = 0, laterFrames = 0, weighed = 0; ///< timed: at a sensor that is not always open
};

/// Adds contributions to one pixel of the pass image. They are summed in double, the last few frames' here: paths of
/// 10 000 bounces make so many equal ones that sums of floats would drift.
class PixelAccumulator {
  public:
    PixelAccumulator(Film& film, const transport::TimeSensor& sensor, int x, int y, uint32_t samples,
                     PathCounters& counters)
        : film_(&film), sensor_(sensor), x_(x), y_(y), scale_(float(1.0 / (double(samples) * sensor.evenWidth()))),
          counters_(counters) {}
    /// Adds nothing anywhere, but tells what paths find.
    PixelAccumulator(SharePilot& pilot, const transport::TimeSensor& sensor, PathCounters& counters)
        : sensor_(sensor), x_(0), y_(0), scale_(1.0f), counters_(counters), pilot_(&pilot) {}
    PixelAccumulator(const PixelAccumulator&) = delete;
    PixelAccumulator& operator=(const PixelAccumulator&) = delete;
    ~PixelAccumulator() {
        for (; used_ != 0; used_ &= used_ - 1) addToFilm(sums_[size_t(std::countr_zero(used_))]);
    }

    /// Who brings the next contributions, beside whom; guided paths count in the window that they aim at.
    void begin(Strategy strategy, const StrategyBalance& balance, const transport::TimeWindow& window = {}) {
        strategy_ = strategy;
        balance_ = balance;
        window_ = window;
        logOfWindow_ = std::log(window.probability);
    }
    /// Light of an emitter, as the strategy's own estimate has it; `time` is the total time of flight, emission time
    /// included; ignored in steady state.
    void add(const Rgb& radiance, double time, const Emitter& emitter, LogRatio logRatio, Found found = Found::Aside) {
        if (!window_.contains(time)) return;
        sensor_.spread(time, emitter,
                       [&](int frame, float share) { put(radiance * share, time, frame, logRatio, found); });
    }
    /// Adds at a time that was drawn inside the gate: rounding at its ends drops nothing, and a delta gate, which no
    /// time meets, takes it with weight 1.
    void addInside(const Rgb& radiance, double time, const Emitter& emitter, LogRatio logRatio) {
        if (sensor_.delays.any()) return add(radiance, time, emitter, logRatio);
        put(radiance, time, sensor_.gate.frames > 1 ? sensor_.gate.nearestFrame(time) : 0, logRatio, Found::Aside);
    }

    /// Whether what arrives then counts.
    [[nodiscard]] bool mayCount(double time) const {
        return time >= sensor_.arrivals.start && time < sensor_.arrivals.end();
    }

  private:
    void tellPilot(float value, int frame, LogRatio logRatio, Found found) {
        if (value != 0.0f) pilot_->tell(value, frame, logRatio, found);
    }
    void count(int frame) {
        ++counters_.arrivals;
        if (!sensor_.gate.steadyState) ++counters_.timed;
        if (sensor_.response) ++counters_.weighed;
        if (frame > 0) ++counters_.laterFrames;
    }

    void put(const Rgb& radiance, double time, int frame, LogRatio logRatio, Found found) {
        if (!isFinite(radiance)) {
            ++counters_.nonFinite;
            return;
        }
        float weight = sensor_.response ? scale_ * float(sensor_.response->pdf(time)) : scale_;
        weight /= window_.probability;
        logRatio = logRatio.plus(logOfWindow_);
        if (pilot_) return tellPilot(meanComponent(radiance) * weight, frame, logRatio, found);
        weight *= balance_.weight(strategy_, logRatio.weighed);
        if (weight > 0.0f) count(frame);
        const size_t place = size_t(frame) % MostFrames;
        FrameSum& sum = sums_[place];
        const bool inUse = (used_ >> place & 1u) != 0;
        if (!inUse || sum.frame != frame) {
            if (inUse) addToFilm(sum);
            used_ |= 1u << place;
            sum = {frame, Vec3d(0.0)};
        }
        sum.value += Vec3d(radiance) * double(weight);
    }

    struct FrameSum {
        int frame;
        Vec3d value;
    };
    void addToFilm(const FrameSum& sum) { film_->add(sum.frame, x_, y_, Rgb(sum.value)); }

    Film* film_ = nullptr;
    const transport::TimeSensor& sensor_;
    int x_, y_;
    float scale_;
    PathCounters& counters_;
    Strategy strategy_ = Strategy::Alone;
    StrategyBalance balance_;
    transport::TimeWindow window_;
    float logOfWindow_ = 0.0f;
    SharePilot* pilot_ = nullptr;
    static constexpr size_t MostFrames = 8;
    uint32_t used_ = 0; ///< bits of the sums below that hold something
    std::array<FrameSum, MostFrames> sums_;
};

} // namespace tungsten::path
