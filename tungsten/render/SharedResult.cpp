#include "tungsten/render/SharedResult.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>

namespace tungsten {

namespace {

constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

/// One line for each counter, then one for each stage with its CPU seconds, those of the process, and its memory.
Bytes statisticsText(const Statistics& statistics) {
    std::ostringstream text;
    text.precision(17);
    for (const auto& [name, value] : statistics.counters()) text << "counter " << value << ' ' << name << '\n';
    for (const auto& [name, stage] : statistics.stages()) text << "stage " << stage.cpuSeconds << ' ' << name << '\n';
    text << "process " << processCpuSeconds() << " cpu\nmemory " << peakMemoryBytes() << " peak\n";
    const std::string all = text.str();
    return {all.begin(), all.end()};
}

/// Wall seconds are rank 0's.
void addText(const Bytes& bytes, SessionResult& result) {
    std::istringstream text(std::string(bytes.begin(), bytes.end()));
    std::string kind, name;
    for (double value = 0.0; text >> kind >> value && std::getline(text.ignore(1), name);) {
        if (kind == "counter") result.statistics.add(name, uint64_t(value));
        if (kind == "stage") result.statistics.addStage(name, 0.0, value);
        if (kind == "process") result.othersCpuSeconds += value;
        if (kind == "memory") result.othersPeakMemory = std::max(result.othersPeakMemory, value);
    }
}

} // namespace

SharedResult::SharedResult(Team* team, SessionResult& result)
    : team_(team), result_(result), film_(team, result.film),
      bias_(team, result.bias), shown_{Unknown, Unknown, {0.0, 0.0}} {
    if (team) result.ranks = team->size();
}

std::vector<double> SharedResult::largest(std::vector<double> values) {
    if (!team_) return values;
    const StageTimer timer(result_.statistics, "wait for other ranks");
    return team_->largest(std::move(values));
}

void SharedResult::shareResumed() {
    if (!team_ || largest({double(result_.film.passes())})[0] == 0.0) return;
    film_.scatter();
    if (result_.estimatesBias()) bias_.scatter();
    result_.samples = uint64_t(result_.film.totalWeight());
}

void SharedResult::collect(size_t passes) {
    if (!team_) return;
    const StageTimer timer(result_.statistics, "exchange passes");
    film_.collect(passes);
    if (result_.estimatesBias()) bias_.collect(passes);
}

void SharedResult::fold(size_t rank, double weight) {
    const uint32_t standsFor = result_.estimatesBias() ? passesOfItsBias(result_.film.passes()) : 0;
    std::optional<StageTimer> timer;
    if (team_) timer.emplace(result_.statistics, "fold passes");
    film_.fold(rank, weight);
    if (standsFor > 0) bias_.fold(rank, double(standsFor));
    whole_ = !team_;
}

void SharedResult::gather() {
    if (!team_ || whole_) return;
    const StageTimer timer(result_.statistics, "gather film");
    const auto start = Clock::now();
    film_.gather();
    if (result_.estimatesBias()) bias_.gather();
    whole_ = true;
    gathered_ = Clock::now();
    gathering_ = gathered_ - start;
}

bool SharedResult::errorIsBelow(double target) {
    gather();
    return largest({double(speaks() && result_.errorBound() <= target)})[0] > 0.0;
}

bool SharedResult::mayShow() const {
    constexpr int Part = 20;
    constexpr std::chrono::seconds Least(2);
    return team_ && Clock::now() - gathered_ > std::max<Clock::duration>(Part * gathering_, Least);
}

ShownErrors SharedResult::errors() {
    if (whole_)
        shown_ = {result_.film.relativeStandardError(), result_.film.relativeErrorBound(), result_.relativeBias()};
    return shown_;
}

void SharedResult::gatherStatistics() {
    if (!team_) return;
    result_.statistics.add("bytes of passes to other ranks", film_.bytesSent() + bias_.bytesSent());
    std::vector<Bytes> parts(size_t(team_->size()));
    if (!speaks()) parts[0] = statisticsText(result_.statistics);
    const std::vector<Bytes> received = team_->exchange(parts);
    if (!speaks()) return;
    for (size_t rank = 1; rank < received.size(); ++rank) addText(received[rank], result_);
}

} // namespace tungsten
