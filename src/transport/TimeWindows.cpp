#include "transport/TimeWindows.h"

#include "transport/Tuning.h"

namespace tungsten::transport {

TimeWindows::TimeWindows(const TimeGate& arrivals, const TimeGate& sequence, double origin, double earliest)
    : TimeWindows(arrivals) {
    // As lengths of paths are similar: from a frame on, where light is there at once.
    const double first = std::max(std::max(arrivals.start, earliest) - origin, sequence.frameWidth),
                 last = arrivals.end() - origin;
    if (sequence.frames < 2 || !(last > first)) return;
    const double wanted = std::ceil(std::log(last / first) / std::log(tuning::WindowGrowth) - 1e-6);
    const int count = int(std::clamp(wanted, 1.0, double(std::min(sequence.frames, tuning::MostWindows))));
    const double growth = std::pow(last / first, 1.0 / count);
    windows_.clear();
    for (int i = 0; i < count; ++i) {
        const double begin = i == 0 ? arrivals.start : windows_.back().end,
                     end = i + 1 == count ? arrivals.end() : origin + first * std::pow(growth, i + 1);
        windows_.push_back({begin, end, 1.0f / float(count)});
    }
}

} // namespace tungsten::transport
