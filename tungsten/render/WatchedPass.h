#pragma once
// One pass, rendered under the eyes of whoever waits for it.

#include "tungsten/render/Integrator.h"
#include "tungsten/render/RenderSession.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <thread>

namespace tungsten {

/// Renders passes until they end, are interrupted, are out of time, or what is called meanwhile throws.
class WatchedPass {
  public:
    using Clock = std::chrono::steady_clock;

    /// Keeps the references. `show` is called some twenty times a second within passes, by the thread that made this.
    WatchedPass(const SessionOptions& options, SessionResult& result, std::function<void(const PassMonitor&)> show)
        : options_(options), result_(result), show_(std::move(show)) {}

    /// `render` renders what it is given: the pass, with a watch. False: it was broken off, and its figures are left
    /// out, but for the time.
    bool run(PassInfo pass, Clock::time_point end, const std::function<void(const PassInfo&, Statistics&)>& render);

    /// Part of the last pass that was broken off which had been rendered.
    [[nodiscard]] double brokenAt() const { return result_.brokenOff.ofPass; }
    [[nodiscard]] bool interrupted() const { return options_.interrupted && options_.interrupted->load(); }
    /// What SessionOptions::duringPass has thrown: later, since within a pass it would not end other threads' parts.
    void rethrow() const {
        if (failed_) std::rethrow_exception(failure_);
    }

  private:
    bool stops(Clock::time_point end);
    void look(Clock::time_point now);

    const SessionOptions& options_;
    SessionResult& result_;
    std::function<void(const PassMonitor&)> show_;
    std::optional<PassMonitor> monitor_; ///< of the pass in progress
    std::thread::id thread_ = std::this_thread::get_id();
    Clock::time_point lastLook_ = Clock::now();
    std::atomic<bool> failed_{false};
    std::exception_ptr failure_; ///< if failed_
};

} // namespace tungsten
