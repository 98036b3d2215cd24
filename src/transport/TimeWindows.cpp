#include "transport/TimeWindows.h"

#include "transport/Tuning.h"

#include "tungsten/integrator/EarliestArrival.h"

namespace tungsten::transport {

TimeWindows TimeWindows::ofSequence(const Scene& scene, const SceneFacts& facts, const TimeGate& arrivals) {
    const TimeGate& sequence = scene.transport.gate;
    double origin = Infinity, earliest = Infinity;
    for (const Emitter& emitter : scene.emitters) origin = std::min(origin, emitter.emissionTime);
    for (const double arrival : earliestArrivals(scene, facts)) earliest = std::min(earliest, arrival);
    // As lengths of paths are similar: from a frame on, where light is there at once.
    const double first = std::max(std::max(arrivals.start, earliest) - origin, sequence.frameWidth),
                 last = arrivals.end() - origin;
    TimeWindows windows(arrivals);
    if (!(last > first)) return windows;
    const double wanted = std::ceil(std::log(last / first) / std::log(tuning::WindowGrowth) - 1e-6);
    const int count = int(std::clamp(wanted, 1.0, double(sequence.frames)));
    const double growth = std::pow(last / first, 1.0 / count);
    windows.windows_.clear();
    for (int i = 0; i < count; ++i) {
        const double begin = i == 0 ? arrivals.start : windows.windows_.back().end,
                     end = i + 1 == count ? arrivals.end() : origin + first * std::pow(growth, i + 1);
        windows.windows_.push_back({begin, end, 1.0f / float(count)});
    }
    return windows;
}

} // namespace tungsten::transport
