// Time of one draw of a distance: candidates, Green's functions, proposals; SIMD against scalar.

#include "darts/DistanceSampler.h"

#include <benchmark/benchmark.h>

#include <random>

namespace {

struct Draw {
    darts::Residual residual;
    float h;
    darts::DistanceRandom random;
};

/// Vertices between one and three mean free paths from the target, 2 % gates.
std::vector<Draw> draws() {
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> u;
    std::vector<Draw> result(1024);
    for (Draw& draw : result) {
        const float C = 1.0f + 2.0f * u(engine), S = C * (1.02f + u(engine));
        draw.residual = darts::Residual::of({0, 0, C}, {0.98 * double(S), double(S)});
        draw.h = 2.0f * u(engine);
        draw.random = {u(engine), u(engine), u(engine), u(engine)};
    }
    return result;
}

void distance(benchmark::State& state, darts::Settings settings, int candidates, bool coloured, bool scalar) {
    settings.candidates = candidates;
    const darts::Medium medium{{0, 0, 0}, coloured ? darts::Vec3{1, 1.5f, 0.7f} : darts::Vec3{1, 1, 1}};
    const darts::DistanceSampler sampler(settings, medium, scalar);
    const std::vector<Draw> inputs = draws();
    size_t i = 0;
    for (auto _ : state) {
        const Draw& draw = inputs[i++ & 1023];
        benchmark::DoNotOptimize(sampler.sample(draw.residual, draw.h, 10.0f, {1, 1, 1}, draw.random));
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
