#pragma once
// Connections of a given length: x -> x + t w -> q with total length S, in forms free of cancellation.

#include <cmath>
#include <limits>

namespace darts {

/// A ray and its target. C is the distance to the target, delta = S - C >= 0 the excess of the connection's length over
/// it, and h = 1 - cos(theta) between the ray and the target's direction, computed as |w - a|^2 / 2 for unit vectors,
/// never as 1 - dot. delta is a difference of large numbers: form it in double, and carry it along a walk by advance().
/// All lengths in one unit.
template <typename Real>
struct Ellipse {
    Real C = 0, delta = 0, h = 0;

    [[nodiscard]] Real length() const { return C + delta; }
    /// S - C cos(theta): the denominator of the polar ellipse.
    [[nodiscard]] Real denominator() const { return delta + C * h; }
    /// First leg t(S) = (S^2 - C^2) / (2 (S - C cos)).
    [[nodiscard]] Real firstLeg() const { return delta * (length() + C) / (2 * denominator()); }
    /// Second leg r(S) = S - t.
    [[nodiscard]] Real secondLeg() const { return (delta * delta + 2 * length() * C * h) / (2 * denominator()); }
    /// dt/dS = r / (S - C cos).
    [[nodiscard]] Real firstLegPerLength() const { return secondLeg() / denominator(); }
    struct Legs {
        Real first, second, firstPerLength;
    };
    /// t, r and dt/dS together, with one division.
    [[nodiscard]] Legs legs() const {
        const Real inverse = 1 / denominator(), second = Real(0.5) * (delta * delta + 2 * length() * C * h) * inverse;
        return {Real(0.5) * delta * (length() + C) * inverse, second, second * inverse};
    }
    /// The needle: ray toward the target and no excess, where any t in [0, C] fits. Measure zero; such connections are
    /// skipped.
    [[nodiscard]] bool isDegenerate() const {
        constexpr Real Ulps = 4;
        return !(denominator() > Ulps * std::numeric_limits<Real>::epsilon() * length());
    }
    /// The same target and arrival seen after going `distance` (at most firstLeg()) along the ray: C' and delta', h to
    /// be set by the next direction. delta' = 2 A (t - d) / (S' + C').
    [[nodiscard]] Ellipse advance(Real distance) const {
        const Real next = distanceToTarget(distance);
        const Real remaining = length() - distance;
        return {next, 2 * denominator() * (firstLeg() - distance) / (remaining + next), 0};
    }
    /// |x + d w - q|.
    [[nodiscard]] Real distanceToTarget(Real distance) const {
        return std::sqrt((distance - C) * (distance - C) + 2 * distance * C * h);
    }
    /// S(t) = t + |x + t w - q|: total length of the connection through the point at t; grows with t.
    [[nodiscard]] Real lengthThrough(Real t) const { return t + distanceToTarget(t); }
};

} // namespace darts
