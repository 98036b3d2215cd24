#pragma once
// Multiple importance sampling of sliced volumes and balls (docs/photon-primitives.md, section 2.7).

#include "photon/primitives/sliced/Ball.h"
#include "photon/primitives/sliced/Volume.h"

namespace tungsten::photon {

/// A path of three flights that both can make: the volume draws the third direction and solves for the lengths, the
/// ball draws the first two lengths and solves for the rest.
template <typename Real>
struct SharedPath {
    std::array<Vector<Real>, 3> directions;
    Real lastLength;
    Real phasePdf;   ///< of the third direction, given the second
    Real flightPdfs; ///< p(t1) p(t2): any function of the path will do, if both use the same

    /// pdf_volume / pdf_ball, (16): of a path of a given length.
    [[nodiscard]] Real ratio(const Vector<Real>& ray, bool warped) const {
        const Vector<Real>& last = directions[2];
        const Real perLength = warped ? (last + ray).length2() / 2 : std::abs(last.dot(ray));
        const Real ball = lastLength * lastLength * perLength;
        return phasePdf * volumeJacobian(directions, ray, warped) / (flightPdfs * ball);
    }
    /// The ratio inside a gate, where the volume draws a point of its chord by the integrand of a medium of this
    /// coefficient, the ball one of what it lights by the angle. 0 where volumes leave the path out. `first`, `second`:
    /// lengths; `gate`: at the base.
    [[nodiscard]] Real ratioInGate(const Vector<Real>& base, Real first, Real second, Real alongRay,
                                   const CameraRay<Real>& sight, const ResidualGate<Real>& gate, Real sigmaT) const {
        auto chord = volumeChord(base, directions, sight);
        if (!chord) return 0;
        chord->keepGate(gate, sight.warp());
        const Real before = first + second;
        const Vector<Real> centre = base + directions[0] * first + directions[1] * second;
        const BallGate<Real> lit = gateBall<Real>(centre, sight, {gate.least - before, gate.most - before});
        // Over the integrand here. The squared last length of both densities cancels.
        const Real integral =
            exponentialIntegral(sigmaT, Real(0), chord->slopeSum() + 1, chord->start - alongRay, chord->end - alongRay);
        const Real volume = phasePdf * chord->jacobian * lit.angles();
        const Real ball = flightPdfs * lit.view.distanceFromRay * integral;
        // A point that rounding has put outside of either is left to the volume alone.
        return ball > 0 && volume > 0 ? volume / ball : std::numeric_limits<Real>::infinity();
    }
};

/// Balance heuristic.
template <typename Real>
Real volumeWeight(Real ratio) {
    return std::isinf(ratio) ? Real(1) : ratio / (1 + ratio);
}
template <typename Real>
Real ballWeight(Real ratio) {
    return 1 / (1 + ratio);
}

} // namespace tungsten::photon
