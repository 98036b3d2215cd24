#pragma once
// When the sensor is open, and how it weighs times of arrival.

#include "transport/RecordingDelays.h"

namespace tungsten::transport {

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
    static TimeSensor of(const Scene& scene, const TimeGate& gate) {
        const TimeProfile& r = scene.transport.response;
        if (r.empty()) {
            TimeSensor sensor{gate};
            sensor.delays = RecordingDelays::of(scene);
            sensor.arrivals = sensor.delays.arrivals(gate);
            return sensor;
        }
        TimeSensor sensor{
            gate, std::make_shared<darts::TemporalResponse>(darts::TemporalResponse::tabulated(r.times, r.values))};
        auto& open = sensor.openTimes;
        for (size_t i = 0; i + 1 < r.times.size(); ++i) {
            if (r.values[i] <= 0.0 && r.values[i + 1] <= 0.0) continue;
            if (open.empty() || open.back().end < r.times[i]) open.push_back({r.times[i], r.times[i]});
            open.back().end = r.times[i + 1];
        }
        return sensor;
    }

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
