// Time of one draw of a distance: candidates, Green's functions, proposals; SIMD against scalar.

#include "Walk.h"

#include "darts/DistanceSampler.h"

#include <benchmark/benchmark.h>

namespace {

void distance(benchmark::State& state, darts::Settings settings, int candidates, bool coloured, bool scalar) {
    settings.candidates = candidates;
    const darts::Medium medium{{0, 0, 0}, coloured ? darts::Vec3{1, 1.5f, 0.7f} : darts::Vec3{1, 1, 1}};
    const darts::DistanceSampler sampler(settings, medium, scalar);
    const auto walk = darts::benchmarks::walk();
    size_t i = 0;
    for (auto _ : state) {
        const auto& [budget, h, u] = walk[i++ % walk.size()];
        benchmark::DoNotOptimize(sampler.sample(budget, {{}, h}, 10.0f, {1, 1, 1}, {u[0], u[1], u[2], u[3]}));
    }
}

const darts::Settings Published = darts::published(darts::Mode::Path), BestPath = darts::best(darts::Mode::Path, 0.0f),
                      BestPhoton = darts::best(darts::Mode::Photon, 0.0f);

} // namespace

BENCHMARK_CAPTURE(distance, published_8, Published, 8, false, false);
BENCHMARK_CAPTURE(distance, published_8_scalar, Published, 8, false, true);
BENCHMARK_CAPTURE(distance, best_photon_8, BestPhoton, 8, false, false);
BENCHMARK_CAPTURE(distance, best_path_4, BestPath, 4, false, false);
BENCHMARK_CAPTURE(distance, best_path_8, BestPath, 8, false, false);
BENCHMARK_CAPTURE(distance, best_path_16, BestPath, 16, false, false);
BENCHMARK_CAPTURE(distance, best_path_8_scalar, BestPath, 8, false, true);
BENCHMARK_CAPTURE(distance, best_path_8_coloured, BestPath, 8, true, false);
