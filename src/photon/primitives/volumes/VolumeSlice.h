#pragma once
// Photon volumes: a slice at one path length, and the chord inside a gate (docs/photon-primitives.md, section 2.4).

#include "photon/primitives/sliced/Chord.h"

#include <optional>

namespace tungsten::photon {

/// Three collapsed flights and the camera ray meet, with a given total length.
template <typename Real>
struct VolumeSlice {
    std::array<Real, 3> lengths; ///< of the flights
    Real alongRay;
    Real jacobian;

    [[nodiscard]] Real flightLength() const { return lengths[0] + lengths[1] + lengths[2]; }
    /// (7) without the power and the phase function at the end: sigma_s^3 E T / J, as for planes.
    [[nodiscard]] Real weight(const Coefficients<Real>& medium, Real before = 0, bool longFlights = true) const {
        return collisions(medium.sigmaS, 3) / jacobian *
               std::exp(-medium.sigmaT * ((longFlights ? flightLength() : 0) + alongRay - before));
    }
};

/// Determinant of space and time by the three lengths and the ray's: (8), by sums or differences of unit vectors.
template <typename Real>
Real volumeJacobian(const std::array<Vector<Real>, 3>& w, const Vector<Real>& ray, bool warped) {
    return std::abs(warped ? determinant<Real>(w[0] + ray, w[1] + ray, w[2] + ray)
                           : determinant<Real>(w[0] - w[2], w[1] - w[2], ray));
}

/// `residual`: path length left at the base, up to the ray's point or, warped, its origin. None where the determinant
/// is at most `least`, or the ray passes beside the slice.
template <typename Real>
std::optional<VolumeSlice<Real>> sliceVolume(const Vector<Real>& base, const std::array<Vector<Real>, 3>& w,
                                             const CameraRay<Real>& sight, Real residual,
                                             Real least = LeastDeterminant<Real>) {
    if (!(residual > 0)) return std::nullopt;
    const Vector<Real>& c = sight.direction;
    const Vector<Real> toOrigin = sight.origin - base;
    const LinearSystem<Real> system = sight.warped ? LinearSystem<Real>(w[0] + c, w[1] + c, w[2] + c)
                                                   : LinearSystem<Real>(w[0] - w[2], w[1] - w[2], -c);
    VolumeSlice<Real> slice{};
    slice.jacobian = std::abs(system.determinant());
    if (!(slice.jacobian > least)) return std::nullopt;
    if (sight.warped) {
        slice.lengths = system.solve(toOrigin + c * residual);
        slice.alongRay = residual - slice.flightLength();
        const auto& t = slice.lengths;
        const Vector<Real> miss = w[0] * t[0] + w[1] * t[1] + w[2] * t[2] - toOrigin - c * slice.alongRay;
        constexpr Real Accuracy = Real(1e-4);
        if (!(miss.length() <= Accuracy * residual)) return std::nullopt;
    } else {
        const auto [t1, t2, t] = system.solve(toOrigin - w[2] * residual);
        slice.lengths = {t1, t2, residual - t1 - t2};
        slice.alongRay = t;
    }
    const auto& [t1, t2, t3] = slice.lengths;
    if (!(t1 >= 0 && t2 >= 0 && t3 >= 0 && sight.holds(slice.alongRay))) return std::nullopt;
    return slice;
}

template <typename Real>
using VolumeChord = Chord<Real, 3>;

/// The part of the ray inside the volume, for any time; its jacobian is |w1 w2 w3|.
template <typename Real>
std::optional<VolumeChord<Real>> volumeChord(const Vector<Real>& base, const std::array<Vector<Real>, 3>& w,
                                             const CameraRay<Real>& sight, Real least = LeastDeterminant<Real>) {
    const LinearSystem<Real> system(w[0], w[1], w[2]);
    const Real jacobian = std::abs(system.determinant());
    if (!(jacobian > least)) return std::nullopt;
    VolumeChord<Real> chord{system.solve(sight.origin - base), system.solve(sight.direction), jacobian, sight.start,
                            sight.end};
    chord.keepFlights(unboundedFlights<Real, 3>());
    return chord.empty() ? std::nullopt : std::optional(chord);
}

} // namespace tungsten::photon
