#pragma once
// When the sensor is open, how it weighs times of arrival, and how long after that light is recorded: pulses and the
// sensor's response (docs/method.md, section 1).

#include "darts/TemporalResponse.h"
#include "darts/TimeBudget.h"

#include "tungsten/core/Random.h"
#include "tungsten/scene/Scene.h"

#include <memory>
#include <vector>

namespace tungsten::transport {

/// How long after an emitter's emission_time its light is recorded, beyond its time of flight.
/// The delays of a scene whose sensor averages over frames; none in steady state.
class RecordingDelays {
  public:
    RecordingDelays() = default;
    static RecordingDelays of(const Scene& scene);

    [[nodiscard]] bool any() const { return !densities_.empty(); }
    /// Density of the delay per time; null for light that is recorded as it arrives. `emitter` is one of the scene's.
    [[nodiscard]] const darts::TemporalResponse* density(const Emitter& emitter) const {
        return any() ? densities_[size_t(&emitter - first_)].get() : nullptr;
    }
    /// A delay by that density. Draws a number only where there is one.
    [[nodiscard]] double sample(const Emitter& emitter, Sampler& sampler) const {
        const darts::TemporalResponse* delay = density(emitter);
        return delay ? delay->quantile(sampler.nextDouble()) : 0.0;
    }
    /// When light that is recorded in `gate` arrives, whichever emitter's: the gate widened by all delays.
    [[nodiscard]] TimeGate arrivals(const TimeGate& gate) const;

  private:
    const Emitter* first_ = nullptr;
    std::vector<std::shared_ptr<const darts::TemporalResponse>> densities_; ///< by emitter
    double least_ = 0.0, most_ = 0.0;
};

/// Weighs time evenly over the gate, or by a response W(T) whose support is the gate. Times are total times of flight,
/// emission time included.
struct TimeSensor {
    TimeGate gate;
    std::shared_ptr<const darts::TemporalResponse> response; ///< null: evenly
    std::vector<darts::TimeGate> openTimes;                  ///< where the response is above 0; empty without one
    RecordingDelays delays;                                  ///< between arrival and record; none with a response
    TimeGate arrivals;                                       ///< when what is recorded in the gate arrives

    TimeSensor(const TimeGate& openDuring, std::shared_ptr<const darts::TemporalResponse> weighedBy = nullptr)
        : gate(openDuring), response(std::move(weighedBy)), arrivals(openDuring) {}
    /// The sensor as the scene says; `gate` is the pass's, which is the scene's or a delta gate's temporal kernel.
    static TimeSensor of(const Scene& scene, const TimeGate& gate);

    /// Frame of a time; 0 in steady state, -1 while the sensor is closed.
    [[nodiscard]] int frameOf(double time) const { return gate.steadyState ? 0 : gate.frameOf(time); }
    /// Calls put(frame, share) for every frame that records a part of what arrives at `time` from this emitter: the
    /// integral of its delay's density over the frame. All of it in one where there is no delay.
    template <typename Put>
    void spread(double time, const Emitter& emitter, const Put& put) const {
        const darts::TemporalResponse* delay = delays.density(emitter);
        if (!delay) {
            const int frame = frameOf(time);
            if (frame >= 0) put(frame, 1.0f);
            return;
        }
        if (!(time + delay->end() > gate.start) || !(time + delay->begin() < gate.end())) return;
        const int last = gate.nearestFrame(time + delay->end());
        int frame = gate.nearestFrame(time + delay->begin());
        double before = delay->distribution(gate.frameStart(frame) - time);
        for (; frame <= last; ++frame) {
            const double until = delay->distribution(gate.frameStart(frame + 1) - time);
            if (until > before) put(frame, float(until - before));
            before = until;
        }
    }
    /// Per unit of time: what light that arrives then counts in the mean over its frame. 1 in steady state and at a
    /// delta gate.
    [[nodiscard]] double density(double time) const { return response ? response->pdf(time) : 1.0 / evenWidth(); }
    /// What contributions are divided by where time is weighed evenly: the frame's width; else 1.
    [[nodiscard]] double evenWidth() const {
        return response || gate.steadyState || gate.delta ? 1.0 : gate.frameWidth;
    }
    /// W(time) times the gate's width, W having the integral 1: relative to an even sensor.
    [[nodiscard]] float weight(double time) const {
        return response ? float(response->pdf(time) * gate.frameWidth) : 1.0f;
    }
    /// Something that arrives at a time in [from, to] may count, as far as the response is concerned.
    [[nodiscard]] bool mayWeigh(double from, double to) const {
        return !response || response->distribution(to) > response->distribution(from);
    }
};

} // namespace tungsten::transport
