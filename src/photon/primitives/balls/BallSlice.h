#pragma once
// Photon balls: every point of a camera ray is reached from a vertex; a path length or a gate chooses among them
// (docs/photon-primitives.md, section 2.5).

#include "photon/primitives/sliced/Chord.h"

namespace tungsten::photon {

/// The last flight, from a ball's centre to the camera ray.
template <typename Real>
struct BallHit {
    Real length, alongRay;
    Real jacobian; ///< of a slice: t^2 |w . c + warp|

    /// (11) without the power and both phase functions: sigma_s E T / J.
    [[nodiscard]] Real weight(const Coefficients<Real>& medium, Real before = 0, bool longFlights = true) const {
        return medium.sigmaS / jacobian * std::exp(-medium.sigmaT * ((longFlights ? length : 0) + alongRay - before));
    }
};

/// A ball's centre as a ray sees it.
template <typename Real>
struct BallView {
    Vector<Real> offset;  ///< centre - origin
    Real toFoot;          ///< along the ray, to the point next to the centre
    Real distanceFromRay; ///< of the centre
    Real distanceFromOrigin;

    BallView(const Vector<Real>& centre, const CameraRay<Real>& sight)
        : offset(centre - sight.origin), toFoot(offset.dot(sight.direction)),
          distanceFromRay(offset.cross(sight.direction).length()), distanceFromOrigin(offset.length()) {}

    /// What a warped path of this length is longer than the way straight back from the foot.
    [[nodiscard]] Real beyondFoot(Real residual) const { return residual - toFoot; }
    /// Where a warped path of this length from the centre over the ray to its origin turns, from the foot: however far
    /// the origin, only beyondFoot() is a difference. Minus infinity where the path is too short for any point.
    [[nodiscard]] Real turn(Real residual) const {
        const Real beyond = beyondFoot(residual), h = distanceFromRay;
        return beyond > 0 ? (beyond - h) * (1 + h / beyond) / 2 : -std::numeric_limits<Real>::infinity();
    }
    /// Half the part of the ray inside a sphere about the centre; 0 outside.
    [[nodiscard]] Real halfChord(Real radius) const {
        return radius > distanceFromRay ? std::sqrt((radius - distanceFromRay) * (radius + distanceFromRay)) : 0;
    }
    /// The chord's ends toFoot -+ half, for a sphere of this radius, without cancellation.
    [[nodiscard]] std::array<Real, 2> chordEnds(Real radius, Real half) const {
        const Real power = (distanceFromOrigin - radius) * (distanceFromOrigin + radius);
        if (toFoot > 0) return {power / (toFoot + half), toFoot + half};
        return {toFoot - half, half - toFoot > 0 ? -power / (half - toFoot) : 0};
    }
};

/// At most two reaches.
template <typename Real>
struct BallSlice {
    std::array<BallHit<Real>, 2> hits{};
    int count = 0;
};

/// `residual` as for volumes.
template <typename Real>
BallSlice<Real> sliceBall(const Vector<Real>& centre, const CameraRay<Real>& sight, Real residual) {
    const BallView<Real> view(centre, sight);
    BallSlice<Real> slice;
    const auto add = [&](Real length, Real t, Real jacobian) {
        if (jacobian > 0 && sight.holds(t)) slice.hits[size_t(slice.count++)] = {length, t, jacobian};
    };
    if (sight.warped) {
        const Real beyond = view.beyondFoot(residual), h = view.distanceFromRay;
        const Real jacobian = (beyond * beyond + h * h) / 2;
        if (beyond > 0) add(jacobian / beyond, view.toFoot + view.turn(residual), jacobian);
    } else {
        const Real half = view.halfChord(residual);
        if (!(half > 0)) return slice;
        for (const Real t : view.chordEnds(residual, half)) add(residual, t, residual * half);
    }
    return slice;
}

/// The part of the ray that a ball lights inside a gate: at most two intervals, in order.
template <typename Real>
struct BallGate {
    BallView<Real> view;
    std::array<Real, 2> start{}, end{}; ///< along the ray, from the foot
    std::array<Real, 2> angle{};        ///< seen from the centre; 0 for an empty interval

    [[nodiscard]] Real angles() const { return angle[0] + angle[1]; }
    /// Equiangular: density along the ray distanceFromRay / (angles() t^2), t from the centre. u in [0, 1).
    [[nodiscard]] BallHit<Real> sample(Real u) const {
        Real turned = u * angles();
        const size_t chosen = turned < angle[0] ? 0 : 1;
        if (chosen == 1) turned -= angle[0];
        const Real h = view.distanceFromRay, from = start[chosen], slope = std::tan(turned);
        const Real ahead = std::clamp(h * (from + h * slope) / (h - from * slope), from, end[chosen]);
        return {std::hypot(h, ahead), view.toFoot + ahead, 0};
    }
    /// (13) without power, both phase functions and the gate's width, at a sample: sigma_s E T angles / h.
    [[nodiscard]] Real weight(const BallHit<Real>& reach, const Coefficients<Real>& medium, Real before = 0,
                              bool longFlights = true) const {
        return medium.sigmaS * angles() / view.distanceFromRay *
               std::exp(-medium.sigmaT * ((longFlights ? reach.length : 0) + reach.alongRay - before));
    }
};

template <typename Real>
BallGate<Real> gateBall(const Vector<Real>& centre, const CameraRay<Real>& sight, const ResidualGate<Real>& gate) {
    BallGate<Real> lit{BallView<Real>(centre, sight)};
    const BallView<Real>& view = lit.view;
    const Real h = view.distanceFromRay;
    if (!(h > 0)) return lit;
    const auto add = [&](size_t i, Real from, Real to) {
        const Real a = lit.start[i] = std::max(from, sight.start - view.toFoot);
        const Real b = lit.end[i] = std::min(to, sight.end - view.toFoot);
        if (!(a < b)) return;
        lit.angle[i] = std::isinf(b) ? std::atan2(h, a) : std::atan2(h * (b - a), h * h + a * b);
    };
    if (sight.warped) {
        add(0, view.turn(gate.least), std::isinf(gate.most) ? gate.most : view.turn(gate.most));
    } else if (gate.most > h) {
        const Real outer = std::isinf(gate.most) ? gate.most : view.halfChord(gate.most);
        const Real inner = view.halfChord(std::max(gate.least, Real(0)));
        if (inner > 0) {
            add(0, -outer, -inner);
            add(1, inner, outer);
        } else {
            add(0, -outer, outer);
        }
    }
    return lit;
}

} // namespace tungsten::photon
