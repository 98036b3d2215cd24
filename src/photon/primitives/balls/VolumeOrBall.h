#pragma once
// Multiple importance sampling of sliced volumes and balls (docs/photon-primitives.md, section 2.7).

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

    /// pdf_volume / pdf_ball, (16).
    [[nodiscard]] Real ratio(const Vector<Real>& ray, bool warped) const {
        const Vector<Real>& last = directions[2];
        const Real perLength = warped ? (last + ray).length2() / 2 : std::abs(last.dot(ray));
        const Real ball = lastLength * lastLength * perLength;
        return phasePdf * volumeJacobian(directions, ray, warped) / (flightPdfs * ball);
    }
};

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
