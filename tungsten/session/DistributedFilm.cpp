#include "tungsten/session/DistributedFilm.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/film/FilmRows.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace tungsten {

namespace {

template <typename Value>
void append(Bytes& bytes, const Value* values, size_t count) {
    const auto* begin = reinterpret_cast<const char*>(values);
    bytes.insert(bytes.end(), begin, begin + count * sizeof(Value));
}

Bytes bytesOf(const std::string& text) {
    return {text.begin(), text.end()};
}

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

DistributedFilm::DistributedFilm(ProcessGroup* group, Film& film) : group_(group), film_(film) {}

int DistributedFilm::firstRowOf(int rank) const {
    const int together = film_.contents().rowsTogether();
    const int64_t groups = (film_.height() + together - 1) / together;
    return std::min(int(groups * rank / group_->size()) * together, film_.height());
}

/// For each rank the rows of this rank's pass image that it owns: their places, each with its values.
std::vector<Bytes> DistributedFilm::rowsFor() const {
    std::vector<Bytes> parts(size_t(group_->size()));
    std::vector<float> values(FilmRows::values(film_));
    for (int rank = 0; rank < group_->size(); ++rank)
        for (int frame = 0; frame < film_.frames(); ++frame)
            for (int y = firstRowOf(rank); y < firstRowOf(rank + 1); ++y) {
                const uint64_t row = uint64_t(frame) * uint64_t(film_.height()) + uint64_t(y);
                if (!FilmRows::isLit(film_, row)) continue;
                append(parts[size_t(rank)], &row, 1);
                FilmRows::readPass(film_, row, values.data());
                append(parts[size_t(rank)], values.data(), values.size());
            }
    return parts;
}

void DistributedFilm::collect(size_t passes) {
    if (!group_) return;
    const bool mine = size_t(group_->rank()) < passes;
    const std::vector<Bytes> parts = mine ? rowsFor() : std::vector<Bytes>(size_t(group_->size()));
    for (size_t rank = 0; rank < parts.size(); ++rank)
        if (int(rank) != group_->rank()) bytesSent_ += parts[rank].size();
    received_ = group_->allToAll(parts);
}

void DistributedFilm::fold(size_t rank, double weight) {
    if (!group_) return film_.endPass(weight);
    film_.beginPass();
    Bytes& rows = received_[rank];
    const size_t size = FilmRows::values(film_) * sizeof(float);
    std::vector<float> values(FilmRows::values(film_));
    for (size_t at = 0; at + sizeof(uint64_t) + size <= rows.size(); at += sizeof(uint64_t) + size) {
        uint64_t row = 0;
        std::memcpy(&row, rows.data() + at, sizeof row);
        std::memcpy(values.data(), rows.data() + at + sizeof row, size);
        FilmRows::setPass(film_, row, values.data());
    }
    Bytes().swap(rows);
    folded_.push_back(FilmRows::accumulate(film_, weight, firstRowOf(group_->rank()), firstRowOf(group_->rank() + 1)));
}

void DistributedFilm::settle() {
    std::vector<Bytes> parts(size_t(group_->size()));
    for (const AccumulatedPass& pass : folded_) append(parts[0], pass.rows.data(), pass.rows.size());
    const std::vector<Bytes> received = group_->allToAll(parts);
    if (group_->rank() == 0)
        for (size_t pass = 0; pass < folded_.size(); ++pass) {
            AccumulatedPass& folded = folded_[pass];
            folded.rows.assign(size_t(film_.height()), {});
            for (int rank = 0; rank < group_->size(); ++rank) {
                const auto rows = size_t(firstRowOf(rank + 1) - firstRowOf(rank));
                std::memcpy(folded.rows.data() + firstRowOf(rank),
                            received[size_t(rank)].data() + pass * rows * sizeof(PassSpread),
                            rows * sizeof(PassSpread));
            }
            FilmRows::finish(film_, folded);
        }
    folded_.clear();
}

void DistributedFilm::gather() {
    if (!group_) return;
    settle();
    std::vector<Bytes> parts(size_t(group_->size()));
    if (group_->rank() > 0) {
        std::ostringstream state;
        const uint64_t nonFinite = film_.nonFiniteSamples() - told_;
        state.write(reinterpret_cast<const char*>(&nonFinite), sizeof nonFinite);
        FilmRows::write(film_, state, firstRowOf(group_->rank()), firstRowOf(group_->rank() + 1));
        parts[0] = bytesOf(state.str());
        told_ = film_.nonFiniteSamples();
    }
    const std::vector<Bytes> received = group_->allToAll(parts);
    for (int rank = 1; group_->rank() == 0 && rank < group_->size(); ++rank) {
        const Bytes& part = received[size_t(rank)];
        std::istringstream state(std::string(part.begin(), part.end()));
        uint64_t nonFinite = 0;
        state.read(reinterpret_cast<char*>(&nonFinite), sizeof nonFinite);
        film_.countNonFinite(nonFinite);
        FilmRows::read(film_, state, firstRowOf(rank), firstRowOf(rank + 1));
    }
}

void DistributedFilm::scatter() {
    if (!group_) return;
    std::vector<Bytes> parts(size_t(group_->size()));
    for (int rank = 1; group_->rank() == 0 && rank < group_->size(); ++rank) {
        std::ostringstream state;
        FilmRows::write(film_, state, firstRowOf(rank), firstRowOf(rank + 1));
        parts[size_t(rank)] = bytesOf(state.str());
    }
    const std::vector<Bytes> received = group_->allToAll(parts);
    if (group_->rank() == 0) return;
    std::istringstream state(std::string(received[0].begin(), received[0].end()));
    FilmRows::read(film_, state, firstRowOf(group_->rank()), firstRowOf(group_->rank() + 1));
}

DistributedResult::DistributedResult(ProcessGroup* group, SessionResult& result)
    : group_(group), result_(result), film_(group, result.film),
      bias_(group, result.bias), shown_{Unknown, Unknown, {0.0, 0.0}} {
    if (group) result.ranks = group->size();
}

std::vector<double> DistributedResult::allReduceMax(std::vector<double> values) {
    if (!group_) return values;
    const StageTimer timer(result_.statistics, "wait for other ranks");
    return group_->allReduceMax(std::move(values));
}

void DistributedResult::shareResumed() {
    if (!group_ || allReduceMax({double(result_.film.passes())})[0] == 0.0) return;
    film_.scatter();
    if (result_.estimatesBias()) bias_.scatter();
    result_.samples = uint64_t(result_.film.totalWeight());
}

void DistributedResult::collect(size_t passes) {
    if (!group_) return;
    const StageTimer timer(result_.statistics, "exchange passes");
    film_.collect(passes);
    if (result_.estimatesBias()) bias_.collect(passes);
}

void DistributedResult::fold(size_t rank, double weight) {
    const uint32_t standsFor = result_.estimatesBias() ? passesOfItsBias(result_.film.passes()) : 0;
    std::optional<StageTimer> timer;
    if (group_) timer.emplace(result_.statistics, "fold passes");
    film_.fold(rank, weight);
    if (standsFor > 0) bias_.fold(rank, double(standsFor));
    whole_ = !group_;
}

void DistributedResult::gather() {
    if (!group_ || whole_) return;
    const StageTimer timer(result_.statistics, "gather film");
    const auto start = Clock::now();
    film_.gather();
    if (result_.estimatesBias()) bias_.gather();
    whole_ = true;
    gathered_ = Clock::now();
    gathering_ = gathered_ - start;
}

bool DistributedResult::errorIsBelow(double target) {
    gather();
    return allReduceMax({double(isRoot() && result_.errorBound() <= target)})[0] > 0.0;
}

bool DistributedResult::mayShow() const {
    constexpr int Part = 20;
    constexpr std::chrono::seconds Least(2);
    return group_ && Clock::now() - gathered_ > std::max<Clock::duration>(Part * gathering_, Least);
}

ShownErrors DistributedResult::errors() {
    if (whole_)
        shown_ = {relativeStandardError(result_.film), relativeErrorBound(result_.film), result_.relativeBias()};
    return shown_;
}

void DistributedResult::gatherStatistics() {
    if (!group_) return;
    result_.statistics.add("bytes of passes to other ranks", film_.bytesSent() + bias_.bytesSent());
    std::vector<Bytes> parts(size_t(group_->size()));
    if (!isRoot()) parts[0] = statisticsText(result_.statistics);
    const std::vector<Bytes> received = group_->allToAll(parts);
    if (!isRoot()) return;
    for (size_t rank = 1; rank < received.size(); ++rank) addText(received[rank], result_);
}

} // namespace tungsten
