#pragma once
// Passes that take long: what they are asked on their way, and what they tell.

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>

namespace tungsten {

/// Leaves a pass that is broken off: none of its image goes into the film.
class PassBrokenOff : public std::runtime_error {
  public:
    PassBrokenOff() : std::runtime_error("the pass was broken off") {}
};

/// Where a pass is.
struct PassProgress {
    std::string stage;
    double ofStage = 0.0; ///< fraction of the stage that is done
    double ofPass = 0.0;  ///< the same of the pass; rough, as stages tell where they lie in it
};

/// Of one pass, on the side of whoever renders it. Threads of the pass may call poll() at once.
class PassMonitor {
  public:
    /// `stops` is asked by every poll, in any thread of the pass, and must not throw.
    explicit PassMonitor(std::function<bool()> stops) : stops_(std::move(stops)) {}

    void stage(const char* name, uint64_t units, double from, double to);
    /// Throws PassBrokenOff once the pass is to stop.
    void poll(uint64_t units) {
        if (units > 0) done_.fetch_add(units, std::memory_order_relaxed);
        if (stops_()) throw PassBrokenOff();
    }
    [[nodiscard]] PassProgress progress() const;

  private:
    std::function<bool()> stops_;
    std::atomic<uint64_t> done_{0};
    mutable std::mutex stageMutex_;
    std::string stage_;
    uint64_t units_ = 0;
    double from_ = 0.0, to_ = 0.0;
};

/// The same on the side of the pass, or of a part of it; without a monitor nobody asks for anything.
class PassWatch {
  public:
    PassWatch() = default;
    explicit PassWatch(PassMonitor& monitor) : monitor_(&monitor) {}

    /// For what is about the part from..to (0 to 1) of this.
    [[nodiscard]] PassWatch part(double from, double to) const {
        PassWatch part = *this;
        part.from_ = from_ + from * (to_ - from_);
        part.to_ = from_ + to * (to_ - from_);
        return part;
    }
    /// Work of so many units begins.
    void stage(const char* name, uint64_t units) const {
        if (monitor_) monitor_->stage(name, units, from_, to_);
    }
    /// To be called wherever about a millisecond's work is done, so many of the stage's units; costs a look at a clock.
    /// Throws PassBrokenOff if the pass is to stop: not to be called where nothing may throw, as in Embree's callbacks.
    void poll(uint64_t units = 1) const {
        if (monitor_) monitor_->poll(units);
    }
    /// The same in a loop over units, at every `span`-th.
    void pollEvery(uint64_t span, uint64_t index) const {
        if (index % span == 0) poll(span);
    }
    /// Within a unit of work.
    void pollWithin(uint64_t span, uint64_t index) const {
        if (index % span == 0) poll(0);
    }

  private:
    PassMonitor* monitor_ = nullptr;
    double from_ = 0.0, to_ = 1.0; ///< of the pass
};

} // namespace tungsten
