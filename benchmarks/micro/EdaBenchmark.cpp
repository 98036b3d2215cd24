// EDA table: building, and sample + pdf at vertices of a walk that stays in a part of the table (warm) or goes
// anywhere.

#include "darts/ConnectionLobe.h"
#include "darts/EdaTable.h"

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <random>

namespace darts {
namespace {

struct Vertex {
    float C, delta, u;
};

/// delta / S log-uniform in [2^lowest, 1), S log-uniform in [1, 2^depths).
std::array<Vertex, 1024> vertices(float lowest, float depths) {
    std::mt19937 bits(1);
    std::uniform_real_distribution<float> uniform;
    std::array<Vertex, 1024> result{};
    for (Vertex& v : result) {
        const float S = std::exp2(depths * uniform(bits)), delta = S * std::exp2(lowest * uniform(bits));
        v = {S - delta, delta, uniform(bits)};
    }
    return result;
}

void edaBuild(benchmark::State& state) {
    for (auto _ : state) {
        const EdaTable table = EdaTable::build(0.9f, 0.0f, {}, unsigned(state.range(0)));
        state.counters["bytes"] = double(table.cumulative().size_bytes() + 5 * table.octaves().size());
    }
}
BENCHMARK(edaBuild)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void edaSampleAndPdf(benchmark::State& state) {
    const EdaTable table = EdaTable::build(0.9f, 0.0f);
    const auto walk = state.range(0) ? vertices(-20.0f, 10.0f) : vertices(-4.0f, 3.0f);
    size_t i = 0;
    for (auto _ : state) {
        const Vertex& v = walk[i++ % walk.size()];
        const float h = table.sample(v.C, v.delta, 1.0f, v.u);
        benchmark::DoNotOptimize(table.pdf(v.C, v.delta, 1.0f, h));
    }
}
BENCHMARK(edaSampleAndPdf)->ArgName("anywhere")->Arg(0)->Arg(1);

void connectionLobeSampleAndPdf(benchmark::State& state) {
    const auto walk = vertices(-4.0f, 3.0f);
    size_t i = 0;
    for (auto _ : state) {
        const Vertex& v = walk[i++ % walk.size()];
        const auto lobe = ConnectionLobe<float>::path(v.C, v.delta);
        benchmark::DoNotOptimize(lobe.pdf(lobe.sample(v.u)));
    }
}
BENCHMARK(connectionLobeSampleAndPdf);

} // namespace
} // namespace darts
