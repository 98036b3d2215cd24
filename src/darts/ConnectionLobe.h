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

} // namespace darts
