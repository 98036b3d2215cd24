#pragma once
// Adaptive quadrature (Boost.Math), compiled once: its templates take a second in every test that integrates.

#include <functional>

namespace tungsten::test {

/// Integral of f from low to high by Gauss-Kronrod rules of 15, 31 or 61 points, halved up to `depth` times until the
/// estimated relative error is at most `tolerance`.
template <unsigned Points>
double integrate(const std::function<double(double)>& f, double low, double high, unsigned depth = 15,
                 double tolerance = 1e-8);

} // namespace tungsten::test
