#include "tungsten/render/WatchedPass.h"

namespace tungsten {

bool WatchedPass::run(PassInfo pass, Clock::time_point end,
                      const std::function<void(const PassInfo&, Statistics&)>& render) {
    monitor_.emplace([this, end] { return stops(end); });
    pass.watch = PassWatch(*monitor_);
    Statistics statistics;
    StageTimer timer(result_.statistics, "passes broken off");
    try {
        render(pass, statistics);
    } catch (const PassBrokenOff&) {
        result_.brokenOff = monitor_->progress();
        return false;
    }
    timer.discard();
    result_.statistics.add(statistics);
    return true;
}

/// Any thread of the pass.
bool WatchedPass::stops(Clock::time_point end) {
    const Clock::time_point now = Clock::now();
    if (std::this_thread::get_id() == thread_) look(now);
    return failed_.load(std::memory_order_relaxed) || interrupted() || now >= end;
}

void WatchedPass::look(Clock::time_point now) {
    constexpr std::chrono::milliseconds Between(50);
    if (now - lastLook_ < Between || failed_) return;
    lastLook_ = now;
    try {
        if (options_.duringPass) options_.duringPass();
    } catch (...) {
        failure_ = std::current_exception();
        failed_ = true;
        return;
    }
    show_(*monitor_);
}

} // namespace tungsten
