#pragma once
// Where a camera ray can meet a primitive of K collapsed flights when one unknown is left: all lengths are linear in
// the distance along the ray (docs/photon-primitives.md, eq. 10 and 15).

#include "photon/primitives/sliced/CameraRay.h"

namespace tungsten::photon {

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
Real chordWeight(const Chord<Real, K>& chord, const Coefficients<Real>& medium, Real before = 0,
                 bool longFlights = true) {
    const Real offset = longFlights ? chord.offsetSum() : 0, slope = longFlights ? chord.slopeSum() : 0;
    return collisions(medium.sigmaS, int(K)) / chord.jacobian *
           exponentialIntegral<Real>(medium.sigmaT, offset - before, slope + 1, chord.start, chord.end);
}

template <typename Real, size_t K>
std::array<Real, K> unboundedFlights() {
    std::array<Real, K> longest;
    longest.fill(std::numeric_limits<Real>::infinity());
    return longest;
}

} // namespace tungsten::photon
