#include "tungsten/integrator/Statistics.h"

#include <sys/resource.h>

namespace tungsten {

void Statistics::add(const std::string& counter, uint64_t amount) {
    const std::scoped_lock lock(mutex_);
    counters_[counter] += amount;
}

void Statistics::addStage(const std::string& stage, double wallSeconds, double cpuSeconds) {
    const std::scoped_lock lock(mutex_);
    Stage& entry = stages_[stage];
    entry.wallSeconds += wallSeconds;
    entry.cpuSeconds += cpuSeconds;
    ++entry.runs;
}

void Statistics::add(const Statistics& others) {
    const std::scoped_lock lock(mutex_, others.mutex_);
    for (const auto& [name, amount] : others.counters_) counters_[name] += amount;
    for (const auto& [name, stage] : others.stages_) {
        Stage& entry = stages_[name];
        entry.wallSeconds += stage.wallSeconds;
        entry.cpuSeconds += stage.cpuSeconds;
        entry.runs += stage.runs;
    }
}

std::map<std::string, uint64_t> Statistics::counters() const {
    const std::scoped_lock lock(mutex_);
    return counters_;
}

std::map<std::string, Statistics::Stage> Statistics::stages() const {
    const std::scoped_lock lock(mutex_);
    return stages_;
}

uint64_t Statistics::counter(const std::string& name) const {
    const std::scoped_lock lock(mutex_);
    const auto found = counters_.find(name);
    return found == counters_.end() ? 0 : found->second;
}

double processCpuSeconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

uint64_t peakMemoryBytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return uint64_t(usage.ru_maxrss) * 1024u;
}

StageTimer::StageTimer(Statistics& statistics, std::string stage)
    : statistics_(statistics), stage_(std::move(stage)), wallStart_(std::chrono::steady_clock::now()),
      cpuStart_(processCpuSeconds()) {}

StageTimer::~StageTimer() {
    if (discarded_) return;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wallStart_;
    statistics_.addStage(stage_, wall.count(), processCpuSeconds() - cpuStart_);
}

} // namespace tungsten
