#pragma once
// Directions matched to the weight of an elliptical connection of a length drawn beforehand. With phase-function
// directions that weight has infinite variance; these lobes, in closed form, remove it.

#include <cmath>

namespace darts {

inline constexpr double TwoPi = 6.283185307179586476925;

/// Density proportional to 1 / (delta^2 + 2 S C h) in h = 1 - cos(theta) about the target's direction: path tracing,
/// where the connection's weight is proportional to 1 / (r (delta + C h)). S = C + delta.
template <typename Real>
class PathConnectionLobe {
  public:
    PathConnectionLobe(Real C, Real delta)
        : slope_(2 * (C + delta) * C), offset_(delta * delta), range_(std::log1p(2 * slope_ / offset_)) {}
    /// u in [0, 1) -> h in [0, 2].
    [[nodiscard]] Real sample(Real u) const {
        if (!(range_ > Real(1e-6))) return 2 * u; // target at the vertex: uniform on the sphere
        return std::fmin(offset_ / slope_ * std::expm1(u * range_), Real(2));
    }
    /// Density per solid angle.
    [[nodiscard]] Real pdf(Real h) const {
        if (!(range_ > Real(1e-6))) return Real(0.5 / TwoPi);
        return slope_ / ((offset_ + slope_ * h) * range_) / Real(TwoPi);
    }

  private:
    Real slope_, offset_, range_;
};

/// Density proportional to 1 / (delta + C h): photon pass, where the image's second moment goes with 1 / (delta + C
/// h)^2.
template <typename Real>
class PhotonConnectionLobe {
  public:
    PhotonConnectionLobe(Real C, Real delta) : slope_(C), offset_(delta), range_(std::log1p(2 * C / delta)) {}
    [[nodiscard]] Real sample(Real u) const {
        if (!(range_ > Real(1e-6))) return 2 * u;
        return std::fmin(offset_ / slope_ * std::expm1(u * range_), Real(2));
    }
    [[nodiscard]] Real pdf(Real h) const {
        if (!(range_ > Real(1e-6))) return Real(0.5 / TwoPi);
        return slope_ / ((offset_ + slope_ * h) * range_) / Real(TwoPi);
    }

  private:
    Real slope_, offset_, range_;
};

} // namespace darts
