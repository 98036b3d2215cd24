#pragma once
// Passes that take long: what they are asked on their way, and what they tell.

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>

namespace tungsten {

/// Leaves a pass that is cancelled: none of its image goes into the film.
class PassCancelled : public std::runtime_error {
  public:
    PassCancelled() : std::runtime_error("the pass was cancelled") {}
};

/// Where a pass is.
struct PassProgress {
    std::string stage;
    double ofStage = 0.0; ///< fraction of the stage that is done
    double ofPass = 0.0;  ///< the same of the pass; rough, as stages tell where they lie in it
};

/// Of one pass, on the side of whoever renders it. Threads of the pass may call advance() at once.
class ProgressMonitor {
  public:
    /// `stops` is asked by every poll, in any thread of the pass, and must not throw.
    explicit ProgressMonitor(std::function<bool()> stops) : stops_(std::move(stops)) {}

    void stage(const char* name, uint64_t units, double from, double to);
    /// Throws PassCancelled once the pass is to stop.
    void advance(uint64_t units) {
        if (units > 0) done_.fetch_add(units, std::memory_order_relaxed);
        if (stops_()) throw PassCancelled();
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
class ProgressToken {
  public:
    ProgressToken() = default;
    explicit ProgressToken(ProgressMonitor& monitor) : monitor_(&monitor) {}

    /// For what is about the part from..to (0 to 1) of this.
    [[nodiscard]] ProgressToken part(double from, double to) const {
        ProgressToken part = *this;
        part.from_ = from_ + from * (to_ - from_);
        part.to_ = from_ + to * (to_ - from_);
        return part;
    }
    /// Work of so many units begins.
    void stage(const char* name, uint64_t units) const {
        if (monitor_) monitor_->stage(name, units, from_, to_);
    }
    /// To be called wherever about a millisecond's work is done, so many of the stage's units; costs a look at a clock.
    /// Throws PassCancelled if the pass is to stop: not to be called where nothing may throw, as in Embree's callbacks.
    void advance(uint64_t units = 1) const {
        if (monitor_) monitor_->advance(units);
    }
    /// The same in a loop over units, at every `span`-th.
    void advanceEvery(uint64_t span, uint64_t index) const {
        if (index % span == 0) advance(span);
    }
    /// Within a unit of work.
    void advanceWithin(uint64_t span, uint64_t index) const {
        if (index % span == 0) advance(0);
    }

  private:
    ProgressMonitor* monitor_ = nullptr;
    double from_ = 0.0, to_ = 1.0; ///< of the pass
};

} // namespace tungsten
