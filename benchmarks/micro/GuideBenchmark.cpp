// Time of a vertex: the control vertex alone, and all that a walk asks a Guide.

#include "Walk.h"

#include "darts/Guide.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace darts {
namespace {

const Medium Fog{{0.1f, 0.1f, 0.1f}, {0.9f, 0.9f, 0.9f}, 0.0f};

/// The connection's length, the place on the ray and the density of both.
void controlVertex(benchmark::State& state) {
    const Guide guide(best(Mode::Photon, 0.0f), Fog);
    const auto walk = benchmarks::walk();
    size_t i = 0;
    for (auto _ : state) {
        const auto& [budget, h, u] = walk[i++ % walk.size()];
        const ConnectionSample connection = guide.sampleConnection(budget, u[0]);
        benchmark::DoNotOptimize(guide.controlVertex(budget, connection, h, INFINITY));
    }
}
BENCHMARK(controlVertex);

/// Length, direction, control vertex, distance, roulette; the random numbers (about 1 ns each) included.
void guideVertex(benchmark::State& state, const Settings& settings, float g) {
    Medium medium = Fog;
    medium.g = g;
    const Guide guide(settings, medium);
    const auto walk = benchmarks::walk();
    uint32_t bits = 1;
    const auto random = [&bits] {
        bits = bits * 1664525u + 1013904223u;
        return float(bits >> 8) * 0x1p-24f;
    };
    const HenyeyGreenstein phase{Vec3{0.6f, 0, 0.8f}, g};
    size_t i = 0;
    for (auto _ : state) {
        const TimeBudget& budget = walk[i++ % walk.size()].budget;
        const ConnectionSample connection = guide.sampleConnection(budget, random());
        const DirectionSample sample = guide.sampleDirection(budget, connection, phase, random);
        benchmark::DoNotOptimize(guide.controlVertex(budget, connection, sample.h, INFINITY));
        benchmark::DoNotOptimize(guide.sampleDistance(budget, sample, INFINITY, {1, 1, 1}, random));
        benchmark::DoNotOptimize(guide.survival(budget.model, guide.logExpectedContribution(budget, 1.0f), 0.0f));
    }
}
BENCHMARK_CAPTURE(guideVertex, published, published(Mode::Path), 0.0f);
BENCHMARK_CAPTURE(guideVertex, best_path, best(Mode::Path, 0.0f), 0.0f);
BENCHMARK_CAPTURE(guideVertex, best_path_peaked, best(Mode::Path, 0.7f), 0.7f);
BENCHMARK_CAPTURE(guideVertex, best_photon, best(Mode::Photon, 0.0f), 0.0f);

} // namespace
} // namespace darts
