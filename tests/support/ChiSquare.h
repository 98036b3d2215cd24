#pragma once
// Pearson's chi-square test of samples against a density.

#include "tungsten/core/Random.h"
#include "tungsten/core/Types.h"

#include <functional>
#include <optional>
#include <vector>

namespace tungsten::test {

/// p-value of observed counts against expected ones; cells expecting fewer than 5 are pooled.
double chiSquarePValue(const std::vector<double>& observed, const std::vector<double>& expected);

/// The chance of failing a correct sampler.
inline constexpr double SmallestPValue = 1e-5;

using DirectionSampler = std::function<std::optional<Vec3f>(Sampler&)>;
using DirectionDensity = std::function<double(const Vec3f&)>;

/// p-value for directions on the sphere; samples that fail (none) must match 1 minus the density's integral.
double chiSquareSphere(const DirectionSampler& sample, const DirectionDensity& density, uint64_t seed = 11,
                       int samples = 200000);

/// p-value for numbers in [0, 1), uniform after mapping by the cumulative distribution.
double chiSquareUniform(const std::function<double(Sampler&)>& sample, uint64_t seed = 12, int samples = 200000);

/// p-value for numbers in cells between `edges`, against the density's integrals by adaptive quadrature; samples
/// outside must match 1 minus the integral over all cells.
double chiSquareInterval(const std::function<double(Sampler&)>& sample, const std::function<double(double)>& density,
                         const std::vector<double>& edges, uint64_t seed = 13, int samples = 100000);

/// `cells` + 1 edges from low to high, in equal steps or (positive ones) in equal ratios.
std::vector<double> evenEdges(double low, double high, int cells);
std::vector<double> ratioEdges(double low, double high, int cells);

} // namespace tungsten::test
