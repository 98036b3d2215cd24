#pragma once
// Pearson's chi-square test of samples against a density.

#include "tungsten/core/Random.h"
#include "tungsten/core/Types.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace tungsten::test {

/// p-value of observed counts against expected ones; cells expecting fewer than 5 are pooled.
inline double chiSquarePValue(const std::vector<double>& observed, const std::vector<double>& expected) {
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

/// The chance of failing a correct sampler.
inline constexpr double SmallestPValue = 1e-5;

using DirectionSampler = std::function<std::optional<Vec3f>(Sampler&)>;
using DirectionDensity = std::function<double(const Vec3f&)>;

/// p-value for directions on the sphere; samples that fail (none) must match 1 minus the density's integral.
inline double chiSquareSphere(const DirectionSampler& sample, const DirectionDensity& density, uint64_t seed = 11,
                              int samples = 200000) {
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

/// p-value for numbers in [0, 1), uniform after mapping by the cumulative distribution.
inline double chiSquareUniform(const std::function<double(Sampler&)>& sample, uint64_t seed = 12,
                               int samples = 200000) {
    constexpr int Bins = 100;
    std::vector<double> observed(Bins, 0.0), expected(Bins, double(samples) / Bins);
    for (int i = 0; i < samples; ++i) {
        Sampler sampler(seed, RandomStream::Test, 0, uint64_t(i));
        observed[size_t(std::clamp(int(sample(sampler) * Bins), 0, Bins - 1))] += 1.0;
    }
    return chiSquarePValue(observed, expected);
}

/// p-value for numbers in cells between `edges`, against the density's integrals by adaptive quadrature; samples
/// outside must match 1 minus the integral over all cells.
inline double chiSquareInterval(const std::function<double(Sampler&)>& sample,
                                const std::function<double(double)>& density, const std::vector<double>& edges,
                                uint64_t seed = 13, int samples = 100000) {
    using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;
    const size_t cells = edges.size() - 1;
    std::vector<double> observed(cells + 1, 0.0), expected(cells + 1, 0.0);
    double total = 0.0;
    for (size_t i = 0; i < cells; ++i) {
        expected[i] = samples * Quadrature::integrate(density, edges[i], edges[i + 1], 8, 1e-7);
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

/// `cells` + 1 edges from low to high, in equal steps or (positive ones) in equal ratios.
inline std::vector<double> evenEdges(double low, double high, int cells) {
    std::vector<double> edges;
    for (int i = 0; i <= cells; ++i) edges.push_back(low + (high - low) * i / cells);
    return edges;
}
inline std::vector<double> ratioEdges(double low, double high, int cells) {
    std::vector<double> edges;
    for (int i = 0; i <= cells; ++i) edges.push_back(low * std::pow(high / low, double(i) / cells));
    return edges;
}

} // namespace tungsten::test
