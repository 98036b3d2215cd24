#pragma once
// Counters and stage times of a render: what happened, how often, how long. They prove that unused stages cost nothing.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace tungsten {

/// Named totals. Threads count locally and add their totals once per batch.
class Statistics {
  public:
    struct Stage {
        double wallSeconds = 0.0;
        double cpuSeconds = 0.0; ///< of the whole process while the stage ran
        uint64_t runs = 0;
    };

    void add(const std::string& counter, uint64_t amount);
    void addStage(const std::string& stage, double wallSeconds, double cpuSeconds);
    void add(const Statistics& others);
    [[nodiscard]] std::map<std::string, uint64_t> counters() const;
    [[nodiscard]] std::map<std::string, Stage> stages() const;
    [[nodiscard]] uint64_t counter(const std::string& name) const; ///< 0 when never counted

  private:
    mutable std::mutex mutex_;
    std::map<std::string, uint64_t> counters_;
    std::map<std::string, Stage> stages_;
};

/// CPU seconds used by the process so far.
double processCpuSeconds();
/// Peak resident memory in bytes.
uint64_t peakMemoryBytes();

/// Times a stage from construction to destruction.
class StageTimer {
  public:
    StageTimer(Statistics& statistics, std::string stage);
    ~StageTimer();
    void discard() { discarded_ = true; } ///< nothing is added
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

  private:
    Statistics& statistics_;
    std::string stage_;
    bool discarded_ = false;
    std::chrono::steady_clock::time_point wallStart_;
    double cpuStart_;
};

} // namespace tungsten
