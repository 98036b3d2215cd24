#pragma once
// Multiple importance sampling of sliced volumes and balls (docs/photon-primitives.md, section 2.7).

#include "photon/primitives/balls/BallSlice.h"
#include "photon/primitives/volumes/VolumeSlice.h"

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
};

/// Where each draws its point inside a gate: density along the ray of the volume's, by the integrand of a medium of this
/// coefficient, over that of the ball's. A path inside a gate has the ratio of (16) times this. 0 where volumes leave
/// the path out. `gate`: at the base.
template <typename Real>
Real placementRatio(const Vector<Real>& base, const std::array<Vector<Real>, 3>& w, const std::array<Real, 3>& lengths,
                    Real alongRay, const SightLine<Real>& sight, const ResidualGate<Real>& gate, Real sigmaT) {
    auto chord = volumeChord(base, w, sight);
    if (!chord) return 0;
    chord->keepGate(gate, sight.warp());
    const Real before = lengths[0] + lengths[1];
    const Vector<Real> centre = base + w[0] * lengths[0] + w[1] * lengths[1];
    const BallGate<Real> lit = gateBall<Real>(centre, sight, {gate.least - before, gate.most - before});
    const Real rise = chord->slopeSum() + 1;
    const Real integral = exponentialIntegral(sigmaT, Real(0), rise, chord->start - alongRay, chord->end - alongRay);
    // Of a point that rounding has put outside of either the volume takes all.
    const Real ball = lit.view.distanceFromRay * integral, volume = lengths[2] * lengths[2] * lit.angles();
    return ball > 0 && volume > 0 ? volume / ball : std::numeric_limits<Real>::infinity();
}

/// Balance heuristic.
template <typename Real>
Real volumeShare(Real ratio) {
    return std::isinf(ratio) ? Real(1) : ratio / (1 + ratio);
}
template <typename Real>
Real ballShare(Real ratio) {
    return 1 / (1 + ratio);
}

} // namespace tungsten::photon
