#include "support/ChiSquare.h"

#include "support/Quadrature.h"

#include <boost/math/distributions/chi_squared.hpp>

#include <algorithm>
#include <cmath>

namespace tungsten::test {

double chiSquarePValue(const std::vector<double>& observed, const std::vector<double>& expected) {
    double statistic = 0.0, pooledObserved = 0.0, pooledExpected = 0.0;
    int cells = 0;
    for (size_t i = 0; i < observed.size(); ++i) {
        pooledObserved += observed[i];
        pooledExpected += expected[i];
        if (pooledExpected < 5.0) continue;
        statistic += (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / pooledExpected;
        ++cells;
        pooledObserved = pooledExpected = 0.0;
    }
    // What is left expects fewer than 5; samples where there should be almost none still count.
    if (pooledObserved > 0.0)
        statistic +=
            (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / std::max(pooledExpected, 0.5);
    if (cells < 2) return 0.0;
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(cells - 1), statistic));
}

double chiSquareSphere(const DirectionSampler& sample, const DirectionDensity& density, uint64_t seed, int samples) {
    // Midpoints integrate the density over a cell, many in z, where cells near the poles span wide angles.
    constexpr int Rows = 24, Columns = 48, FineZ = 64, FinePhi = 4;
    std::vector<double> observed(Rows * Columns + 1, 0.0), expected(Rows * Columns + 1, 0.0);
    for (int i = 0; i < samples; ++i) {
        Sampler sampler(seed, RandomStream::Test, 0, uint64_t(i));
        const auto direction = sample(sampler);
        if (!direction) {
            observed.back() += 1.0;
            continue;
        }
        const double u = (double(direction->z) + 1.0) * 0.5;
        const double v = std::atan2(double(direction->y), double(direction->x)) / (2.0 * 3.14159265358979323846) + 0.5;
        observed[size_t(std::clamp(int(u * Rows), 0, Rows - 1) * Columns +
                        std::clamp(int(v * Columns), 0, Columns - 1))] += 1.0;
    }
    double total = 0.0;
    for (int cell = 0; cell < Rows * Columns; ++cell) {
        double sum = 0.0;
        for (int k = 0; k < FineZ * FinePhi; ++k) {
            const double z = 2.0 * (cell / Columns + (k / FinePhi + 0.5) / FineZ) / Rows - 1.0;
            const double phi =
                2.0 * 3.14159265358979323846 * ((cell % Columns + (k % FinePhi + 0.5) / FinePhi) / Columns - 0.5);
            const double radius = std::sqrt(1.0 - z * z);
            sum += density(Vec3f(float(radius * std::cos(phi)), float(radius * std::sin(phi)), float(z)));
        }
        expected[size_t(cell)] = sum / (FineZ * FinePhi) * (4.0 * 3.14159265358979323846 / (Rows * Columns)) * samples;
        total += expected[size_t(cell)];
    }
    expected.back() = std::max(double(samples) - total, 0.0);
    return chiSquarePValue(observed, expected);
}

double chiSquareUniform(const std::function<double(Sampler&)>& sample, uint64_t seed, int samples) {
    constexpr int Bins = 100;
    std::vector<double> observed(Bins, 0.0), expected(Bins, double(samples) / Bins);
    for (int i = 0; i < samples; ++i) {
        Sampler sampler(seed, RandomStream::Test, 0, uint64_t(i));
        observed[size_t(std::clamp(int(sample(sampler) * Bins), 0, Bins - 1))] += 1.0;
    }
    return chiSquarePValue(observed, expected);
}

double chiSquareInterval(const std::function<double(Sampler&)>& sample, const std::function<double(double)>& density,
                         const std::vector<double>& edges, uint64_t seed, int samples) {
    const size_t cells = edges.size() - 1;
    std::vector<double> observed(cells + 1, 0.0), expected(cells + 1, 0.0);
    double total = 0.0;
    for (size_t i = 0; i < cells; ++i) {
        expected[i] = samples * test::integrate<15>(density, edges[i], edges[i + 1], 8, 1e-7);
        total += expected[i];
    }
    expected[cells] = std::max(samples - total, 0.0);
    for (int i = 0; i < samples; ++i) {
        Sampler sampler(seed, RandomStream::Test, 0, uint64_t(i));
        const double x = sample(sampler);
        const auto above = std::upper_bound(edges.begin(), edges.end(), x);
        const bool inside = above != edges.begin() && above != edges.end();
        observed[inside ? size_t(above - edges.begin()) - 1 : cells] += 1.0;
    }
    return chiSquarePValue(observed, expected);
}

std::vector<double> evenEdges(double low, double high, int cells) {
    std::vector<double> edges;
    for (int i = 0; i <= cells; ++i) edges.push_back(low + (high - low) * i / cells);
    return edges;
}

std::vector<double> ratioEdges(double low, double high, int cells) {
    std::vector<double> edges;
    for (int i = 0; i <= cells; ++i) edges.push_back(low * std::pow(high / low, double(i) / cells));
    return edges;
}

} // namespace tungsten::test
