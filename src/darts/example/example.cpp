// Light that scatters once on its way from a vertex to a target 2 away, arriving after a path of length 2.5 to 2.6, in
// a medium without boundaries: int int sigmaS / (4 pi) e^{-sigmaT S} / r^2 dt dw, by either preset.

#include "darts/Guide.h"

#include <cstdio>
#include <random>

int main() {
    const darts::Medium medium{{0.1f, 0.1f, 0.1f}, {0.7f, 0.7f, 0.7f}, 0.0f};
    const darts::TimeBudget budget = darts::TimeBudget::of({0.0f, 0.0f, 2.0f}, {2.5, 2.6});
    const darts::HenyeyGreenstein isotropic;
    const auto estimate = [&](const darts::Settings& settings) {
        const darts::Guide guide(settings, medium);
        std::mt19937 bits;
        const auto random = [&bits] { return float(bits() >> 8) * 0x1p-24f; };
        constexpr int Samples = 1000000;
        double sum = 0.0;
        for (int i = 0; i < Samples; ++i) {
            // A direction, the connection's length S, the vertex where the path has this length.
            const auto sample = guide.sampleDirection(budget, {}, isotropic, random);
            const auto connection = guide.sampleConnectionAlong(budget, sample.h, random());
            const auto vertex = guide.controlVertex(budget, connection, sample.h, INFINITY);
            if (!vertex) continue;
            const float S = vertex->distance + vertex->toTarget, sigmaS = medium.sigmaS.x, sigmaT = medium.sigmaT().x;
            const float contribution =
                sigmaS / (4.0f * darts::Pi) * std::exp(-sigmaT * S) / (vertex->toTarget * vertex->toTarget);
            sum += double(contribution * vertex->inversePdf * sample.inversePdf);
        }
        return sum / Samples;
    };
    const double best = estimate(darts::best(darts::Mode::Path, 0.0f));
    const double published = estimate(darts::published(darts::Mode::Path));
    std::printf("best: %.5f   published: %.5f\n", best, published);
    return std::abs(best - published) < 0.01 * best ? 0 : 1;
}
