#include "path/WeightWindows.h"

#include "path/Tuning.h"
#include "transport/Tuning.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

WeightWindows::Axis WeightWindows::Axis::of(std::vector<double> values, int cells) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    if (values.empty()) return {};
    const auto quantile = [&](double part) {
        const auto place = values.begin() + std::ptrdiff_t(part * double(values.size() - 1));
        std::nth_element(values.begin(), place, values.end());
        return *place;
    };
    const double start = quantile(0.01), width = quantile(0.99) - start;
    return {start, width > 0.0 ? double(cells) / width : 0.0};
}

size_t WeightWindows::stateOf(const Vec3f& position, double time, bool inMedium) const {
    int state = (inMedium ? Times : 0) + times_.cell(time, Times);
    for (int axis = 0; axis < 3; ++axis)
        state = state * Cells + places_[size_t(axis)].cell(double(position[axis]), Cells);
    return size_t(state);
}

double WeightWindows::learn(const Record& path) {
    double later = 0.0;
    size_t found = path.pilot.contributions();
    for (size_t i = path.vertices.size(); i-- > 0;) {
        const Record::Vertex& vertex = path.vertices[i];
        while (found > vertex.found) later += double(path.pilot.value(--found));
        learned_.push_back({vertex.position, vertex.time, vertex.inMedium, later / double(vertex.throughput),
                            float(path.vertices.size() - i)});
    }
    // Of the first vertex, or of a path that met none.
    const double ofOne = path.vertices.empty() ? 0.0 : learned_.back().found;
    starts_.add({ofOne, ofOne * ofOne, std::max(double(path.vertices.size()), 1.0), 1.0});
    while (found > 0) later += double(path.pilot.value(--found));
    return later;
}

void WeightWindows::learn(const std::array<Record, 2>& pair) {
    const double difference = learn(pair[0]) - learn(pair[1]);
    variance_ += 0.5 * difference * difference;
}

auto WeightWindows::byState(const std::vector<Learned>& learned) -> std::vector<Sums> {
    const auto axisOf = [&](int cells, auto&& value) {
        std::vector<double> values;
        for (const Learned& vertex : learned) values.push_back(value(vertex));
        return Axis::of(std::move(values), cells);
    };
    times_ = axisOf(Times, [](const Learned& vertex) { return vertex.time; });
    for (int axis = 0; axis < 3; ++axis)
        places_[size_t(axis)] = axisOf(Cells, [=](const Learned& vertex) { return double(vertex.position[axis]); });
    std::vector<Sums> sums(2 * Times * CellsOfTime);
    for (const Learned& vertex : learned)
        sums[stateOf(vertex.position, vertex.time, vertex.inMedium)].add(
            {vertex.found, vertex.found * vertex.found, double(vertex.vertices), 1.0});
    return sums;
}

void WeightWindows::finish() {
    const std::vector<Learned> learned = std::exchange(learned_, {});
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
    const std::vector<Sums> sums = byState(learned);
    std::vector<Sums> ofTimes(2 * Times);
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
