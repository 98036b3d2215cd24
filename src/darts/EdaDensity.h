#pragma once
// Elliptical diffusion approximation (He et al. 2024): how much light a direction can still bring to the target, if
// what follows its first flight is taken from the diffusion approximation.

namespace darts {

/// log f of a direction, f(cos | C, S) = int_0^{t(S)} e^{-tau} Phi(rho(tau), S - tau) dtau, up to a term common to all
/// directions of the same C and S. Phi is DiffusionGreensFunction, t and rho are those of Ellipse. Lengths are in mean
/// free paths (sigmaT = 1): C is the distance to the target, delta = S - C > 0, h = 1 - cos(theta) in [0, 2].
/// Within 2e-4 for S from 1e-6 to 1e4, C / S up to 1 - 1e-7 and every albedo and g.
[[nodiscard]] double edaLogDensity(double albedo, double g, double C, double delta, double h);

} // namespace darts
