#pragma once
// A camera ray as the primitives see it that integrate over the lengths of flights, and the linear algebra that they
// share (docs/photon-primitives.md, sections 2.3 to 2.6); chords, where it can meet one of K collapsed flights when one
// unknown is left: all lengths are linear in the distance along it (docs/photon-primitives.md, eq. 10 and 15).

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

/// Path lengths that are left of a gate at the primitive's base: [least, most).
template <typename Real>
struct ResidualGate {
    Real least, most;
    [[nodiscard]] Real width() const { return most - least; }
};

/// Integral of e^{-sigma (offset + slope t)} over [start, end], without cancellation for small slopes.
template <typename Real>
Real exponentialIntegral(Real sigma, Real offset, Real slope, Real start, Real end) {
    const Real length = end - start;
    if (!(length > 0)) return 0;
    // From the end where the integrand is larger, so that nothing overflows.
    const Real z = sigma * std::abs(slope) * length, peak = slope >= 0 ? start : end;
    const Real mean = z < Real(1e-8) ? 1 - z / 2 : -std::expm1(-z) / z;
    return std::exp(-sigma * (offset + slope * peak)) *
           (std::isinf(length) ? 1 / (sigma * std::abs(slope)) : length * mean);
}

template <typename Real, size_t K>
struct Chord {
    std::array<Real, K> offset, slope; ///< lengths t_i = offset + slope t
    Real jacobian;                     ///< absolute value of the determinant
    Real start, end;                   ///< along the ray; empty unless start < end

    [[nodiscard]] bool empty() const { return !(start < end); }
    [[nodiscard]] Real length(size_t i, Real t) const { return offset[i] + slope[i] * t; }
    [[nodiscard]] Real offsetSum() const {
        Real sum = 0;
        for (const Real p : offset) sum += p;
        return sum;
    }
    [[nodiscard]] Real slopeSum() const {
        Real sum = 0;
        for (const Real q : slope) sum += q;
        return sum;
    }
    /// Keeps the part where least <= p + q t <= most.
    void keep(Real p, Real q, Real least, Real most) {
        if (q == 0) {
            if (!(p >= least && p <= most)) end = start;
            return;
        }
        const Real a = (least - p) / q, b = (most - p) / q;
        start = std::max(start, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    /// Keeps what lies inside every flight: all lengths >= 0 and at most `longest`.
    void keepFlights(const std::array<Real, K>& longest) {
        for (size_t i = 0; i < K; ++i) keep(offset[i], slope[i], 0, longest[i]);
    }
    /// Keeps total lengths inside the gate.
    void keepGate(const ResidualGate<Real>& gate, Real warp) {
        keep(offsetSum(), slopeSum() + warp, gate.least, gate.most);
    }
};

/// (10) for three flights, (15) for four, without power, phase function and a box gate's width: sigma_s^K / J times the
/// integral over the chord.
template <typename Real, size_t K>
Real chordWeight(const Chord<Real, K>& chord, const Coefficients<Real>& medium, bool longFlights = true) {
    const Real offset = longFlights ? chord.offsetSum() : 0, slope = longFlights ? chord.slopeSum() : 0;
    return collisions(medium.sigmaS, int(K)) / chord.jacobian *
           exponentialIntegral<Real>(medium.sigmaT, offset, slope + 1, chord.start, chord.end);
}

template <typename Real, size_t K>
std::array<Real, K> unboundedFlights() {
    std::array<Real, K> longest;
    longest.fill(std::numeric_limits<Real>::infinity());
    return longest;
}

} // namespace tungsten::photon
