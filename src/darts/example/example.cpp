// Light that scatters once on its way from a vertex to a target 2 away, arriving after a path of length 2.5 to 2.6, in
// a medium without boundaries: int int sigmaS / (4 pi) e^{-sigmaT S} dt / r^2 dw, by control vertices.

#include "darts/ConnectionLobe.h"
#include "darts/ControlVertex.h"
#include "darts/EdaTable.h"

#include <cstdio>
#include <random>

int main() {
    const float C = 2.0f, sigmaT = 0.8f, sigmaS = 0.7f;
    const darts::ConnectionLength<float> length{2.5f, 0.1f, sigmaT};
    const darts::EdaTable table = darts::EdaTable::build(sigmaS / sigmaT, 0.0f);
    std::mt19937 bits;
    std::uniform_real_distribution<float> uniform;

    double byLobe = 0.0, byTable = 0.0;
    constexpr int Samples = 1000000;
    for (int i = 0; i < Samples; ++i) {
        // The length first, then a direction that suits it, then the vertex that gives the path this length.
        const float offset = length.sample(uniform(bits)).offset, S = length.low + offset, delta = S - C;
        const auto contribution = [&](float h, float directionPdf) {
            const darts::Ellipse<float> connection{C, delta, h};
            const float r = connection.secondLeg(), t = connection.firstLeg();
            const float vertexPdf = darts::controlVertexPdf(connection, length.pdf(offset));
            return sigmaS / (2 * darts::TwoPi) * std::exp(-sigmaT * (t + r)) / (r * r) / (vertexPdf * directionPdf);
        };
        const auto lobe = darts::ConnectionLobe<float>::path(C, delta);
        const float hLobe = lobe.sample(uniform(bits)), hTable = table.sample(C, delta, sigmaT, uniform(bits));
        byLobe += contribution(hLobe, lobe.pdf(hLobe)) / Samples;
        byTable += contribution(hTable, table.pdf(C, delta, sigmaT, hTable)) / Samples;
    }
    std::printf("connection lobe: %.5f   EDA table: %.5f\n", byLobe, byTable);
    return std::abs(byLobe - byTable) < 0.01 * byLobe ? 0 : 1;
}
