#include "tungsten/integrator/ProgressToken.h"

#include <algorithm>

namespace tungsten {

void ProgressMonitor::stage(const char* name, uint64_t units, double from, double to) {
    const std::scoped_lock lock(stageMutex_);
    stage_ = name;
    units_ = units;
    from_ = from;
    to_ = to;
    done_.store(0, std::memory_order_relaxed);
}

PassProgress ProgressMonitor::progress() const {
    const std::scoped_lock lock(stageMutex_);
    const double done = double(done_.load(std::memory_order_relaxed));
    const double part = units_ > 0 ? std::min(done / double(units_), 1.0) : 0.0;
    return {stage_, part, from_ + part * (to_ - from_)};
}

} // namespace tungsten
