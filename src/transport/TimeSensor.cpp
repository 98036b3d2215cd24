#include "transport/TimeSensor.h"

#include <algorithm>

namespace tungsten::transport {

namespace {

using Density = std::shared_ptr<const darts::TemporalResponse>;

Density densityOf(const TimeProfile& profile) {
    if (profile.empty()) return nullptr;
    return std::make_shared<darts::TemporalResponse>(darts::TemporalResponse::tabulated(profile.times, profile.values));
}

} // namespace

RecordingDelays RecordingDelays::of(const Scene& scene) {
    RecordingDelays delays;
    const bool pulses = std::any_of(scene.emitters.begin(), scene.emitters.end(),
                                    [](const Emitter& emitter) { return !emitter.pulse.empty(); });
    if (scene.transport.gate.steadyState || (scene.transport.delay.empty() && !pulses)) return delays;
    const Density sensor = densityOf(scene.transport.delay);
    delays.first_ = scene.emitters.data();
    const TimeProfile none, *last = &none;
    Density density = sensor;
    for (const Emitter& emitter : scene.emitters) {
        // Lamps of one kind share theirs.
        if (!(emitter.pulse == *last)) {
            density = densityOf(emitter.pulse);
            if (!density)
                density = sensor;
            else if (sensor)
                density =
                    std::make_shared<darts::TemporalResponse>(darts::TemporalResponse::convolved(*density, *sensor));
            last = &emitter.pulse;
        }
        delays.densities_.push_back(density);
    }
    double least = Infinity, most = -Infinity;
    for (const Density& each : delays.densities_) {
        least = std::min(least, each ? each->begin() : 0.0);
        most = std::max(most, each ? each->end() : 0.0);
    }
    delays.least_ = least;
    delays.most_ = most;
    return delays;
}

TimeGate RecordingDelays::arrivals(const TimeGate& gate) const {
    if (!any() || gate.steadyState) return gate;
    TimeGate widened = gate;
    widened.start = gate.start - most_;
    widened.frameWidth = gate.end() - least_ - widened.start;
    widened.frames = 1;
    return widened;
}

TimeSensor TimeSensor::of(const Scene& scene, const TimeGate& gate) {
    const TimeProfile& r = scene.transport.response;
    TimeSensor sensor{gate, densityOf(r)};
    if (r.empty()) {
        sensor.delays = RecordingDelays::of(scene);
        sensor.arrivals = sensor.delays.arrivals(gate);
        return sensor;
    }
    auto& open = sensor.openTimes;
    for (size_t i = 0; i + 1 < r.times.size(); ++i) {
        if (r.values[i] <= 0.0 && r.values[i + 1] <= 0.0) continue;
        if (open.empty() || open.back().end < r.times[i]) open.push_back({r.times[i], r.times[i]});
        open.back().end = r.times[i + 1];
    }
    return sensor;
}

} // namespace tungsten::transport
