#pragma once
// What arrives at distance rho after path length s in an infinite medium: approximations that shape sampling, as
// logarithms.

#include <cmath>
#include <limits>

namespace darts {

/// Diffusion: log Phi = -3/2 log(4 pi D s) - rho^2 / (4 D s) - sigmaA s with D = 1 / (3 (sigmaA + sigmaS (1 - g))); per
/// unit volume. Minus infinity where light cannot have got (s <= rho).
template <typename Real>
struct DiffusionGreensFunction {
    Real sigmaA = 0, sigmaS = 1, g = 0;

    [[nodiscard]] Real log(Real rho, Real s) const {
        if (!(s > rho)) return -std::numeric_limits<Real>::infinity();
        const Real fourDs = 4 * s / (3 * (sigmaA + sigmaS * (1 - g)));
        return Real(-1.5) * std::log(Real(3.14159265358979323846L) * fourDs) - rho * rho / fourDs - sigmaA * s;
    }
};

/// Causal (Paasschens 1997), scattered part, for isotropic scattering (or reduced sigmaS (1 - g)): within 5 % nearly
/// everywhere. u = 1 - rho^2 / s^2 is an argument of its own, because along a walk it is known without cancellation.
template <typename Real>
struct CausalGreensFunction {
    Real sigmaA = 0, sigmaS = 1;

    [[nodiscard]] Real log(Real u, Real s) const {
        if (!(u > 0)) return -std::numeric_limits<Real>::infinity();
        const Real meanFreePaths = s * sigmaS, r = std::sqrt(u), q = std::sqrt(r);
        const Real less = (1 - u) * (r + q + 1) / ((q + 1) * (r + 1)); // 1 - u^{3/4}, exact towards u = 1
        constexpr Real Normalisation = Real(-2.148617937451772);       // -3/2 log(4 pi / 3)
        // One exponent, -(s/l)(1 - u^{3/4}): two would overflow and underflow against each other.
        return Normalisation - 3 * std::log(s) +
               std::log(meanFreePaths * std::sqrt((meanFreePaths * r * q + Real(2.026)) / r)) - meanFreePaths * less -
               sigmaA * s;
    }
};

} // namespace darts
