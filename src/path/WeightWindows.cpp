#include "path/WeightWindows.h"

#include "path/Tuning.h"
#include "transport/Tuning.h"

#include <algorithm>
#include <cmath>

namespace tungsten::path {

namespace {

/// No path is ended with a probability of more than 1 - Least, times its throughput, nor split into more than Most.
constexpr double Least = 0.1, Most = 100.0;

} // namespace

void WeightWindows::Sums::add(const Sums& other, double part) {
    found += part * other.found;
    squares += part * other.squares;
    vertices += part * other.vertices;
    states += part * other.states;
}

WeightWindows::WeightWindows(const Scene& scene, double end) : sums_(size_t(2 * Times * Cells * Cells * Cells)) {
    if (std::isfinite(end) && end > 0.0) timeScale_ = double(Times) / end;
    const Vec3f low = scene.geometry->boundsMin(), size = scene.geometry->boundsMax() - low;
    for (int axis = 0; axis < 3; ++axis) {
        const float scale = float(Cells) / size[axis];
        if (!(scale > 0.0f && std::isfinite(scale) && std::isfinite(low[axis]))) continue;
        corner_[axis] = low[axis];
        cellScale_[axis] = scale;
    }
}

size_t WeightWindows::stateOf(const transport::PathState& path, const transport::WalkVertex& vertex) const {
    const auto time = int(std::clamp(path.time * timeScale_, 0.0, double(Times - 1)));
    int state = (vertex.medium ? Times : 0) + time;
    for (int axis = 0; axis < 3; ++axis) {
        const float place = (vertex.position[axis] - corner_[axis]) * cellScale_[axis];
        state = state * Cells + int(std::clamp(place, 0.0f, float(Cells - 1)));
    }
    return size_t(state);
}

double WeightWindows::learn(const Record& path) {
    double later = 0.0;
    size_t found = path.pilot.contributions();
    for (size_t i = path.vertices.size(); i-- > 0;) {
        const Record::Vertex& vertex = path.vertices[i];
        while (found > vertex.found) later += double(path.pilot.value(--found));
        const double ofOne = later / double(vertex.throughput);
        const Sums here{ofOne, ofOne * ofOne, double(path.vertices.size() - i), 1.0};
        sums_[vertex.state].add(here);
        if (i == 0) starts_.add(here);
    }
    while (found > 0) later += double(path.pilot.value(--found));
    if (path.vertices.empty()) starts_.add({later, later * later, 1.0, 1.0});
    return later;
}

void WeightWindows::learn(const std::array<Record, 2>& pair) {
    const double difference = learn(pair[0]) - learn(pair[1]);
    variance_ += 0.5 * difference * difference;
}

void WeightWindows::finish() {
    const std::vector<Sums> sums = std::move(sums_);
    sums_.clear();
    if (starts_.effective() < transport::tuning::LeastEffective || !(variance_ > 0.0)) return;
    const double ofStart = std::sqrt(2.0 * variance_ / starts_.vertices);
    const double expected = starts_.effective() / starts_.states;
    // The logarithm of what has been found at a state, and of what is around it as far as that is too little.
    const auto logFactor = [&](const Sums& at, bool splits, double around) {
        const double mean = at.states > 0.0 ? at.found * at.found / at.states : 0.0;
        const double value = std::max(splits ? at.squares - mean : at.squares, 0.0);
        const double enough = at.effective() + expected * at.states;
        if (!(enough > 0.0)) return around;
        const double own = std::log(std::max(std::sqrt(value / at.vertices) / ofStart, 0.1 * Least));
        return around + (own - around) * enough / (enough + tuning::EnoughOfState);
    };
    constexpr auto CellsOfTime = size_t(Cells * Cells * Cells);
    std::vector<Sums> ofTimes(sums.size() / CellsOfTime);
    for (size_t state = 0; state < sums.size(); ++state) ofTimes[state / CellsOfTime].add(sums[state]);
    factors_.resize(sums.size());
    for (size_t time = 0; time < ofTimes.size(); ++time) {
        Sums around = ofTimes[time];
        const size_t inOrder = time % size_t(Times);
        if (inOrder > 0) around.add(ofTimes[time - 1], 0.5);
        if (inOrder + 1 < size_t(Times)) around.add(ofTimes[time + 1], 0.5);
        const double split = logFactor(around, true, 0.0), survival = logFactor(around, false, 0.0);
        for (size_t state = time * CellsOfTime; state < (time + 1) * CellsOfTime; ++state) {
            const auto of = [&](bool splits, double otherwise) {
                return float(std::clamp(std::exp(logFactor(sums[state], splits, otherwise)), Least, Most));
            };
            factors_[state] = {of(true, split), of(false, survival)};
        }
    }
}

} // namespace tungsten::path
