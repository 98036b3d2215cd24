#pragma once
// Directions matched to the weight of an elliptical connection of a length drawn beforehand. With phase-function
// directions that weight has infinite variance; these lobes, in closed form, remove it.

#include "darts/FastMath.h"

#include <algorithm>

namespace darts {

inline constexpr double TwoPi = 6.283185307179586476925;

/// Density proportional to 1 / (kappa + h) in h = 1 - cos(theta) about the target's direction, azimuth uniform. With
/// L = log(1 + 2 / kappa): h = kappa (e^{u L} - 1), density per solid angle 1 / (2 pi (kappa + h) L).
template <typename Real>
class ConnectionLobe {
  public:
    /// Path tracing: proportional to 1 / (delta^2 + 2 S C h), the connection's weight 1 / (r (delta + C h)), S = C +
    /// delta.
    static ConnectionLobe path(Real C, Real delta) { return ConnectionLobe(delta / (C + delta) * (delta / (2 * C))); }
    /// Photon pass: proportional to 1 / (delta + C h); the image's second moment goes with 1 / (delta + C h)^2.
    static ConnectionLobe photon(Real C, Real delta) { return ConnectionLobe(delta / C); }

    /// Proportional to 1 / (rate - pull cos), pull < rate: where walks go whose next flights, exponential of that rate
    /// otherwise, gain e^{pull d cos} by going d in the direction of the axis.
    static ConnectionLobe drift(Real rate, Real pull) { return ConnectionLobe((rate - pull) / pull); }

    /// u in [0, 1) -> h in [0, 2]. Never NaN (kappa has bounds), so std::min serves: fmin would be a call.
    [[nodiscard]] Real sample(Real u) const { return std::min(kappa_ * fastExpm1(u * range_), Real(2)); }
    /// Its inverse.
    [[nodiscard]] Real part(Real h) const { return fastLog1p(h / kappa_) / range_; }
    /// Density per solid angle.
    [[nodiscard]] Real pdf(Real h) const { return 1 / (Real(TwoPi) * (kappa_ + h) * range_); }

  private:
    /// Bounds: a target at the vertex (C = 0, kappa infinite or NaN) is the uniform sphere, the needle (delta = 0)
    /// stays a density.
    explicit ConnectionLobe(Real kappa)
        : kappa_(kappa < Real(1e30) ? std::max(kappa, Real(1e-30)) : Real(1e30)), range_(fastLog1p(2 / kappa_)) {}

    Real kappa_, range_;
};

/// Lobe of connections whose excess lengths delta are uniform from `low` on: the integral of path() over them is, with
/// a = sqrt(2 S C h),
///   (atan((low + width) / a) - atan(low / a)) / a  ~  1 / (y (k + y))  within a factor of 1.7,
/// y = sqrt(h + start^2), start = low / sqrt(2 S C), k = (2 / pi) width / sqrt(2 S C). Azimuth uniform. With
/// L = log((k + sqrt(2 + start^2)) / (k + start)): y - start = (k + start) (e^{u L} - 1), density per solid angle
/// 1 / (4 pi y (k + y) L).
template <typename Real>
class UniformLengthLobe {
  public:
    UniformLengthLobe(Real C, Real low, Real width) {
        const Real scale = 1 / std::sqrt(2 * (C + low + Real(0.5) * width) * C);
        k_ = std::max(bounded(Real(2 / 3.141592653589793) * width * scale), Real(1e-15));
        start_ = bounded(low * scale);
        range_ = fastLog1p(2 / ((k_ + start_) * (start_ + std::sqrt(2 + start_ * start_))));
    }

    [[nodiscard]] Real sample(Real u) const {
        const Real beyond = (k_ + start_) * fastExpm1(u * range_); // y - start
        return std::min(beyond * (beyond + 2 * start_), Real(2));
    }
    /// Density per solid angle.
    [[nodiscard]] Real pdf(Real h) const {
        const Real y = std::sqrt(std::max(h, Real(1e-30)) + start_ * start_);
        return 1 / (Real(2 * TwoPi) * y * (k_ + y) * range_);
    }

  private:
    /// NaN, of a target at the vertex, too.
    [[nodiscard]] static Real bounded(Real x) { return x < Real(1e15) ? x : Real(1e15); }

    Real k_, start_, range_;
};

/// Directions of camera paths for all excess lengths from `low` to `low` + `width`: half by their lobe, half by that of
/// the middle one. The first alone keeps the variance of connections finite where lengths begin at 0; but it sends
/// paths that go on too close to the target's direction. (Variance of guided paths with a quarter, a half, three
/// quarters and all of it: scattering 6.0 0.95, 1, 1.04, 1.1, lamp in fog 0.96, 1, 1, 1.1, gate of 2.5 1.03, 1, 0.96,
/// 0.94. Bench: study gate-width, bodies.)
template <typename Real>
class GateLobe {
  public:
    GateLobe(Real C, Real low, Real width)
        : middle_(ConnectionLobe<Real>::path(C, low + Real(0.5) * width)), all_(C, low, width) {}

    [[nodiscard]] Real sample(Real u) const { return u < Real(0.5) ? all_.sample(2 * u) : middle_.sample(2 * u - 1); }
    /// Density per solid angle.
    [[nodiscard]] Real pdf(Real h) const { return Real(0.5) * (all_.pdf(h) + middle_.pdf(h)); }

  private:
    ConnectionLobe<Real> middle_;
    UniformLengthLobe<Real> all_;
};

} // namespace darts
