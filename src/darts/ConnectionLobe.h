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

/// Density proportional to 1 / (x (k + x)) in x = sqrt(h), azimuth uniform: the integral of path() over excess lengths
/// from 0 on, up to the target's direction, where no single one of them is right. With L = log(1 + sqrt(2) / k):
/// x = k (e^{u L} - 1), density per solid angle 1 / (4 pi x (k + x) L).
template <typename Real>
class OpenGateLobe {
  public:
    /// Lobe of connections whose excess lengths are uniform up to `width`: (1 / a) atan(width / a), a = sqrt(2 S C h),
    /// within three tenths.
    OpenGateLobe(Real C, Real S, Real width)
        : OpenGateLobe(Real(2 / 3.141592653589793) * width / std::sqrt(2 * S * C)) {}

    [[nodiscard]] Real sample(Real u) const {
        const Real x = k_ * fastExpm1(u * range_);
        return std::min(x * x, Real(2));
    }
    /// Density per solid angle.
    [[nodiscard]] Real pdf(Real h) const {
        const Real x = std::sqrt(std::max(h, Real(1e-30)));
        return 1 / (Real(2 * TwoPi) * x * (k_ + x) * range_);
    }

  private:
    explicit OpenGateLobe(Real k)
        : k_(k < Real(1e15) ? std::max(k, Real(1e-15)) : Real(1e15)), range_(fastLog1p(Real(1.4142135623730951) / k_)) {
    }

    Real k_, range_;
};

/// Directions of camera paths for all excess lengths from `low` to `low` + `width` alike: the lobe of the middle one,
/// and beside it, the more the lengths differ, the open gate's. Without that the weight of connections has infinite
/// variance where lengths begin at 0; more of it leads paths that scatter often astray. (Variance x CPU of guided paths
/// over the middle's lobe alone and over the open gate's alone: cornell-fog in a gate of 2.5, 0.8 and 1.2, lamp in fog
/// 0.97 and 0.5. Bench: study gate-width, bodies.)
template <typename Real>
class GateLobe {
  public:
    GateLobe(Real C, Real low, Real width)
        : middle_(ConnectionLobe<Real>::path(C, low + Real(0.5) * width)), open_(C, C + low + Real(0.5) * width, width),
          share_(MostOpen * width / (low + width)) {}

    [[nodiscard]] Real sample(Real u) const {
        if (u < share_) return open_.sample(u / share_);
        return middle_.sample(std::min((u - share_) / (1 - share_), Real(0x1.fffffep-1)));
    }
    /// Density per solid angle.
    [[nodiscard]] Real pdf(Real h) const { return share_ * open_.pdf(h) + (1 - share_) * middle_.pdf(h); }

  private:
    static constexpr Real MostOpen = Real(0.25);

    ConnectionLobe<Real> middle_;
    OpenGateLobe<Real> open_;
    Real share_;
};

} // namespace darts
