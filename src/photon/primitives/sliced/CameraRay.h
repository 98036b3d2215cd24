#pragma once
// A camera ray as the primitives see it that integrate over the lengths of flights, and the linear algebra that they
// share (docs/photon-primitives.md, sections 2.3 to 2.6).

#include "tungsten/core/Types.h"

#include <array>

namespace tungsten::photon {

template <typename Real>
using Vector = Imath::Vec3<Real>;

/// x = origin + t direction, start <= t <= end; the direction has unit length.
template <typename Real>
struct CameraRay {
    Vector<Real> origin, direction;
    Real start = 0, end = std::numeric_limits<Real>::infinity();
    bool warped = true; ///< its length counts in times: false with `camera_unwarped`

    [[nodiscard]] Real warp() const { return warped ? Real(1) : Real(0); }
    [[nodiscard]] bool holds(Real t) const { return t >= start && t <= end; }
    [[nodiscard]] Vector<Real> at(Real t) const { return origin + direction * t; }
};

/// |a b c|
template <typename Real>
Real determinant(const Vector<Real>& a, const Vector<Real>& b, const Vector<Real>& c) {
    return a.dot(b.cross(c));
}

/// Determinants of unit vectors, their sums and differences have no dimension: below this, rounding is all they hold.
template <typename Real>
inline constexpr Real LeastDeterminant = sizeof(Real) == sizeof(float) ? Real(1e-4) : Real(1e-6);

/// Columns a, b and c, for any number of right-hand sides.
template <typename Real>
class LinearSystem {
  public:
    LinearSystem(const Vector<Real>& a, const Vector<Real>& b, const Vector<Real>& c)
        : rows_{b.cross(c), c.cross(a), a.cross(b)}, determinant_(a.dot(rows_[0])) {}

    [[nodiscard]] Real determinant() const { return determinant_; }
    /// The x, y, z of x a + y b + z c = r; the determinant is not 0.
    [[nodiscard]] std::array<Real, 3> solve(const Vector<Real>& r) const {
        const Real inverse = 1 / determinant_;
        return {r.dot(rows_[0]) * inverse, r.dot(rows_[1]) * inverse, r.dot(rows_[2]) * inverse};
    }

  private:
    std::array<Vector<Real>, 3> rows_;
    Real determinant_;
};

/// Coefficients of a medium in one channel, per length.
template <typename Real>
struct Coefficients {
    Real sigmaS, sigmaT;
};

/// The first `k` powers' last: sigma_s of k collapsed collisions.
template <typename Real>
Real collisions(Real sigmaS, int k) {
    Real product = 1;
    for (int i = 0; i < k; ++i) product *= sigmaS;
    return product;
}

} // namespace tungsten::photon
