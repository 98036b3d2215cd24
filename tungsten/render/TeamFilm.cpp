#include "tungsten/render/TeamFilm.h"

#include <cstring>
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

} // namespace

TeamFilm::TeamFilm(Team* team, Film& film) : team_(team), film_(film) {}

int TeamFilm::firstRowOf(int rank) const {
    const int together = film_.contents().rowsTogether();
    const int64_t groups = (film_.height() + together - 1) / together;
    return std::min(int(groups * rank / team_->size()) * together, film_.height());
}

/// For each rank the rows of this rank's pass image that it owns: their places, each with its values.
std::vector<Bytes> TeamFilm::rowsFor() const {
    std::vector<Bytes> parts(size_t(team_->size()));
    std::vector<float> values(film_.rowValues());
    for (int rank = 0; rank < team_->size(); ++rank)
        for (int frame = 0; frame < film_.frames(); ++frame)
            for (int y = firstRowOf(rank); y < firstRowOf(rank + 1); ++y) {
                const uint64_t row = uint64_t(frame) * uint64_t(film_.height()) + uint64_t(y);
                if (!film_.passRowIsLit(row)) continue;
                append(parts[size_t(rank)], &row, 1);
                film_.readPassRow(row, values.data());
                append(parts[size_t(rank)], values.data(), values.size());
            }
    return parts;
}

void TeamFilm::collect(size_t passes) {
    if (!team_) return;
    const bool mine = size_t(team_->rank()) < passes;
    const std::vector<Bytes> parts = mine ? rowsFor() : std::vector<Bytes>(size_t(team_->size()));
    for (size_t rank = 0; rank < parts.size(); ++rank)
        if (int(rank) != team_->rank()) bytesSent_ += parts[rank].size();
    received_ = team_->exchange(parts);
}

void TeamFilm::fold(size_t rank, double weight) {
    if (!team_) return film_.endPass(weight);
    film_.beginPass();
    Bytes& rows = received_[rank];
    const size_t size = film_.rowValues() * sizeof(float);
    std::vector<float> values(film_.rowValues());
    for (size_t at = 0; at + sizeof(uint64_t) + size <= rows.size(); at += sizeof(uint64_t) + size) {
        uint64_t row = 0;
        std::memcpy(&row, rows.data() + at, sizeof row);
        std::memcpy(values.data(), rows.data() + at + sizeof row, size);
        film_.setPassRow(row, values.data());
    }
    Bytes().swap(rows);
    folded_.push_back(film_.foldRows(weight, firstRowOf(team_->rank()), firstRowOf(team_->rank() + 1)));
}

void TeamFilm::settle() {
    std::vector<Bytes> parts(size_t(team_->size()));
    for (const FoldedPass& pass : folded_) append(parts[0], pass.rows.data(), pass.rows.size());
    const std::vector<Bytes> received = team_->exchange(parts);
    if (team_->rank() == 0)
        for (size_t pass = 0; pass < folded_.size(); ++pass) {
            FoldedPass& folded = folded_[pass];
            folded.rows.assign(size_t(film_.height()), {});
            for (int rank = 0; rank < team_->size(); ++rank) {
                const auto rows = size_t(firstRowOf(rank + 1) - firstRowOf(rank));
                std::memcpy(folded.rows.data() + firstRowOf(rank),
                            received[size_t(rank)].data() + pass * rows * sizeof(PassDeviation),
                            rows * sizeof(PassDeviation));
            }
            film_.settle(folded);
        }
    folded_.clear();
}

void TeamFilm::gather() {
    if (!team_) return;
    settle();
    std::vector<Bytes> parts(size_t(team_->size()));
    if (team_->rank() > 0) {
        std::ostringstream state;
        const uint64_t nonFinite = film_.nonFiniteSamples() - told_;
        state.write(reinterpret_cast<const char*>(&nonFinite), sizeof nonFinite);
        film_.writeRows(state, firstRowOf(team_->rank()), firstRowOf(team_->rank() + 1));
        parts[0] = bytesOf(state.str());
        told_ = film_.nonFiniteSamples();
    }
    const std::vector<Bytes> received = team_->exchange(parts);
    for (int rank = 1; team_->rank() == 0 && rank < team_->size(); ++rank) {
        const Bytes& part = received[size_t(rank)];
        std::istringstream state(std::string(part.begin(), part.end()));
        uint64_t nonFinite = 0;
        state.read(reinterpret_cast<char*>(&nonFinite), sizeof nonFinite);
        film_.countNonFinite(nonFinite);
        film_.readRows(state, firstRowOf(rank), firstRowOf(rank + 1));
    }
}

void TeamFilm::scatter() {
    if (!team_) return;
    std::vector<Bytes> parts(size_t(team_->size()));
    for (int rank = 1; team_->rank() == 0 && rank < team_->size(); ++rank) {
        std::ostringstream state;
        film_.writeRows(state, firstRowOf(rank), firstRowOf(rank + 1));
        parts[size_t(rank)] = bytesOf(state.str());
    }
    const std::vector<Bytes> received = team_->exchange(parts);
    if (team_->rank() == 0) return;
    std::istringstream state(std::string(received[0].begin(), received[0].end()));
    film_.readRows(state, firstRowOf(team_->rank()), firstRowOf(team_->rank() + 1));
}

} // namespace tungsten
