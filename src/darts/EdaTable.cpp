#include "darts/EdaTable.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace darts {

namespace {

/// Positive half of the 16-point Gauss-Legendre rule.
constexpr std::array<double, 8> GaussNodes{0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                           0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                           0.9445750230732326, 0.9894009349916499};
constexpr std::array<double, 8> GaussWeights{0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                             0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                             0.0622535239386479, 0.0271524594117541};

/// Parts of the integrand below e^-Cutoff of its maximum are left out.
constexpr double Cutoff = 20.0;

/// The integrand over v = log s, s = S - tau the length of what follows the first flight. With s^2 - rho^2 =
/// 2 (delta + C h) s - delta^2 - 2 S C h, its logarithm is -kappa s - log(s) / 2 - b / s + constant.
struct LogIntegrand {
    double kappa, fourDInverse, C, delta, h;

    [[nodiscard]] double length() const { return C + delta; }
    /// 0 at s = S but for what depends on neither h nor s. The exponent's h-dependence is written so that it vanishes
    /// there without cancellation.
    [[nodiscard]] double at(double v) const {
        const double s = std::exp(v), tau = length() - s;
        return kappa * tau - 0.5 * v - fourDInverse * (delta * delta + 2.0 * C * h * tau) / s;
    }
    /// Where the logarithm is largest and smallest, if anywhere: roots of kappa s^2 + s / 2 - b.
    [[nodiscard]] std::array<double, 2> turningLengths() const {
        const double b = fourDInverse * (delta * delta + 2.0 * length() * C * h);
        const double discriminant = 0.25 + 4.0 * kappa * b;
        if (!(discriminant >= 0.0)) return {0.0, 0.0};
        const double sum = 0.5 + std::sqrt(discriminant);
        return {2.0 * b / sum, kappa < 0.0 ? -0.5 * sum / kappa : 0.0};
    }
};

/// Moves the lower end of a monotone piece up to where the integrand is at least e^-Cutoff of the maximum.
double clipToCutoff(const LogIntegrand& f, double low, double high, double maximum) {
    if (f.at(low) > maximum - Cutoff) return low;
    for (int i = 0; i < 12; ++i) {
        const double middle = 0.5 * (low + high);
        (f.at(middle) > maximum - Cutoff ? high : low) = middle;
    }
    return low;
}

double gaussLegendre(const LogIntegrand& f, double from, double to, double maximum) {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0.0;
    for (size_t i = 0; i < GaussNodes.size(); ++i)
        sum += GaussWeights[i] * (std::exp(f.at(middle - half * GaussNodes[i]) - maximum) +
                                  std::exp(f.at(middle + half * GaussNodes[i]) - maximum));
    return std::abs(half) * sum;
}

} // namespace

double edaLogDensity(double albedo, double g, double C, double delta, double h) {
    const double fourDInverse = 0.75 * (1.0 - albedo * g), S = C + delta;
    const LogIntegrand f{fourDInverse - albedo, fourDInverse, C, delta, h};
    const double shortest = (delta * delta + 2.0 * S * C * h) / (2.0 * (delta + C * h));

    // Monotone pieces, each integrated from its larger end as far as it matters.
    std::array<double, 4> ends{std::log(shortest), std::log(S), std::log(S), std::log(S)};
    size_t pieces = 1;
    for (const double s : f.turningLengths())
        if (s > shortest && s < S) ends[pieces++] = std::log(s);
    ends[pieces] = std::log(S);
    double maximum = f.at(ends[0]);
    for (size_t i = 1; i <= pieces; ++i) maximum = std::max(maximum, f.at(ends[i]));

    double sum = 0.0;
    for (size_t i = 0; i < pieces; ++i) {
        double low = ends[i], high = ends[i + 1];
        if (f.at(low) > f.at(high)) std::swap(low, high);
        if (f.at(high) < maximum - Cutoff) continue;
        low = clipToCutoff(f, low, high, maximum);
        sum += gaussLegendre(f, low, high, maximum);
    }
    return maximum + std::log(sum);
}

namespace {

using Row = EdaTable::Row;

/// log f at an albedo, a g and a row's C and delta, in mean free paths.
struct RowDensity {
    double albedo, g, C, delta;
    [[nodiscard]] double log(double h) const { return edaLogDensity(albedo, g, C, delta, h); }
};

/// Upper edge of the first bin in h.
double firstEdge(int octaves) {
    return 1.0 / ((1 << Row::Log2PerOctave) * double(Row::scaleOf(octaves)));
}

/// The fewest octaves that leave at most 2 % of the directions to the first bin, beside which nothing is resolved.
int octavesFor(const RowDensity& f) {
    constexpr int Levels = Row::MaxOctaves + 3;
    std::array<double, Levels> mass; // about h = 2^(1-i), up to a common factor
    double maximum = -std::numeric_limits<double>::infinity(), total = 0.0;
    for (int i = 0; i < Levels; ++i) {
        mass[size_t(i)] = f.log(std::ldexp(1.0, 1 - i)) - i * std::log(2.0);
        maximum = std::max(maximum, mass[size_t(i)]);
    }
    for (double& m : mass) total += m = std::exp(m - maximum);
    int octaves = Row::MinOctaves;
    for (; octaves < Row::MaxOctaves; ++octaves) {
        double first = 0.0;
        for (int i = 0; i < Levels; ++i)
            if (std::ldexp(1.0, 1 - i) <= firstEdge(octaves)) first += mass[size_t(i)];
        if (first <= 0.02 * total) break;
    }
    return octaves;
}

/// Integrals of f over the bins, normalised to sum 1.
std::vector<double> binMasses(const RowDensity& f, int octaves) {
    // Gauss-Legendre over sqrt(h), in which f is smooth even where it rises with h^(-1/2) toward the needle.
    constexpr std::array<double, 3> Nodes{-0.7745966692414834, 0.0, 0.7745966692414834}, Weights{5.0, 8.0, 5.0};
    const int bins = Row::binsOf(octaves);
    const Row edges(nullptr, octaves);
    std::vector<double> terms(size_t(bins) * Nodes.size());
    double maximum = -std::numeric_limits<double>::infinity();
    for (int bin = 0; bin < bins; ++bin) {
        const double low = std::sqrt(double(edges.edge(bin))), high = std::sqrt(double(edges.edge(bin + 1)));
        for (size_t i = 0; i < Nodes.size(); ++i) {
            const double root = 0.5 * (low + high) + 0.5 * (high - low) * Nodes[i];
            const double term = f.log(root * root) + std::log(Weights[i] * root * (high - low));
            terms[size_t(bin) * Nodes.size() + i] = term;
            maximum = std::max(maximum, term);
        }
    }
    std::vector<double> masses(size_t(bins), 0.0);
    double total = 0.0;
    for (size_t i = 0; i < terms.size(); ++i) {
        const double term = std::exp(terms[i] - maximum);
        masses[i / Nodes.size()] += term;
        total += term;
    }
    for (double& mass : masses) mass /= total;
    return masses;
}

std::vector<float> cumulativeOf(const RowDensity& f, int octaves, double floor) {
    std::vector<double> masses = binMasses(f, octaves);
    const Row edges(nullptr, octaves);
    std::vector<float> cumulative(size_t(Row::strideOf(octaves)), 1.0f);
    double sum = 0.0;
    for (int bin = 0; bin < Row::binsOf(octaves); ++bin) {
        cumulative[size_t(bin)] = float(sum);
        const double even = 0.5 * double(edges.edge(bin + 1) - edges.edge(bin)), perBin = 1.0 / Row::binsOf(octaves);
        sum += (1.0 - floor) * masses[size_t(bin)] + 0.5 * floor * (even + perBin);
    }
    return cumulative;
}

/// Runs work(i) for i in [0, count) on as many threads as asked for and to be had.
template <typename Work>
void inParallel(int count, unsigned threads, const Work& work) {
    std::atomic<int> next{0};
    const auto run = [&] {
        for (int i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::jthread> others;
    try {
        for (unsigned i = 1; i < std::min(threads, unsigned(count)); ++i) others.emplace_back(run);
    } catch (const std::system_error&) { // no more threads: those there are do the work
    }
    run();
}

} // namespace

void EdaTable::requireValid(float albedo, float g, const EdaResolution& r) {
    const auto require = [](bool holds, const char* message) {
        if (!holds) throw std::invalid_argument(message);
    };
    require(albedo >= 0.0f && albedo <= 1.0f, "EDA table: albedo must be in [0, 1]");
    require(g >= -1.0f && g <= 1.0f, "EDA table: g must be in [-1, 1]");
    require(r.excessOctaves >= 1 && r.excessOctaves <= 24 && r.log2ExcessPerOctave >= 0 && r.log2ExcessPerOctave <= 4,
            "EDA table: delta / S must have 1 to 24 octaves of 1 to 16 bins");
    require(r.lowestDepthLog2 >= -20 && r.depthOctaves >= 1 && r.depthOctaves <= 34 &&
                r.lowestDepthLog2 + r.depthOctaves <= 14 && r.log2DepthPerOctave >= 0 && r.log2DepthPerOctave <= 4,
            "EDA table: sigmaT S must lie within 2^-20 to 2^14, with 1 to 16 bins an octave");
    require(r.floor >= 1e-3f && r.floor <= 1.0f, "EDA table: the floor must be in [0.001, 1]");
}

EdaTable EdaTable::build(float albedo, float g, const EdaResolution& resolution, unsigned threads) {
    requireValid(albedo, g, resolution);
    const OctaveBins excess = resolution.excess(), depth = resolution.depth();
    const auto rows = size_t(excess.count()) * size_t(depth.count());
    EdaTable table(albedo, g, resolution);
    table.octaves_.resize(rows);
    std::vector<std::vector<float>> cumulative(rows);
    inParallel(int(rows), threads ? threads : std::thread::hardware_concurrency(), [&](int i) {
        const double S = depth.centre(i % depth.count()), delta = S * double(excess.centre(i / depth.count()));
        const RowDensity f{albedo, g, S - delta, delta};
        const int octaves = octavesFor(f);
        table.octaves_[size_t(i)] = std::uint8_t(octaves);
        cumulative[size_t(i)] = cumulativeOf(f, octaves, double(resolution.floor));
    });
    for (const auto& row : cumulative) table.cumulative_.insert(table.cumulative_.end(), row.begin(), row.end());
    table.index();
    return table;
}

std::shared_ptr<const EdaTable> EdaTable::shared(float albedo, float g) {
    requireValid(albedo, g, {}); // before NaN becomes a key
    static std::mutex mutex;
    static std::map<std::pair<float, float>, std::weak_ptr<const EdaTable>> tables;
    const std::lock_guard lock(mutex);
    std::erase_if(tables, [](const auto& entry) { return entry.second.expired(); });
    auto& entry = tables[{albedo, g}];
    if (auto table = entry.lock()) return table;
    auto table = std::make_shared<const EdaTable>(build(albedo, g));
    entry = table;
    return table;
}

bool EdaTable::index() {
    if (octaves_.size() != size_t(resolution_.excess().count()) * size_t(resolution_.depth().count())) return false;
    size_t next = 0;
    first_.clear();
    for (const int octaves : octaves_) {
        if (octaves < Row::MinOctaves || octaves > Row::MaxOctaves) return false;
        first_.push_back(std::uint32_t(next));
        next += size_t(Row::strideOf(octaves));
    }
    return next == cumulative_.size();
}

std::optional<EdaTable> EdaTable::restore(float albedo, float g, const EdaResolution& resolution,
                                          std::vector<std::uint8_t> octaves, std::vector<float> cumulative) {
    requireValid(albedo, g, resolution);
    EdaTable table(albedo, g, resolution);
    table.octaves_ = std::move(octaves);
    table.cumulative_ = std::move(cumulative);
    if (!table.index()) return std::nullopt;
    for (size_t i = 0; i < table.octaves_.size(); ++i) {
        const float* row = table.cumulative_.data() + table.first_[i];
        const int bins = Row::binsOf(table.octaves_[i]);
        if (row[0] != 0.0f) return std::nullopt;
        for (int bin = 0; bin < bins; ++bin)
            if (!(row[bin + 1] > row[bin])) return std::nullopt;
        for (int bin = bins; bin < Row::strideOf(table.octaves_[i]); ++bin)
            if (row[bin] != 1.0f) return std::nullopt;
    }
    return table;
}

} // namespace darts
