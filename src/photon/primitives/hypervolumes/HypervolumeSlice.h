#pragma once
// Photon hypervolumes: four collapsed flights at one path length (docs/photon-primitives.md, section 2.6).

#include "photon/primitives/sliced/Chord.h"

#include <optional>

namespace tungsten::photon {

template <typename Real>
using HypervolumeChord = Chord<Real, 4>;

/// Holds neither the camera ray nor the warp: a property of the directions.
template <typename Real>
Real hypervolumeJacobian(const std::array<Vector<Real>, 4>& w) {
    return std::abs(determinant<Real>(w[0] - w[3], w[1] - w[3], w[2] - w[3]));
}

/// The part of the ray where paths of the length `residual` (as for volumes) meet it.
template <typename Real>
std::optional<HypervolumeChord<Real>> sliceHypervolume(const Vector<Real>& base, const std::array<Vector<Real>, 4>& w,
                                                       const CameraRay<Real>& sight, Real residual,
                                                       Real least = LeastDeterminant<Real>) {
    if (!(residual > 0)) return std::nullopt;
    const LinearSystem<Real> system(w[0] - w[3], w[1] - w[3], w[2] - w[3]);
    const Real jacobian = std::abs(system.determinant());
    if (!(jacobian > least)) return std::nullopt;
    const Real warp = sight.warp();
    const auto p = system.solve(sight.origin - base - w[3] * residual);
    const auto q = system.solve(sight.direction + w[3] * warp);
    HypervolumeChord<Real> chord{{p[0], p[1], p[2], residual - p[0] - p[1] - p[2]},
                                 {q[0], q[1], q[2], -warp - q[0] - q[1] - q[2]},
                                 jacobian,
                                 sight.start,
                                 sight.end};
    chord.keepFlights(unboundedFlights<Real, 4>());
    return chord.empty() ? std::nullopt : std::optional(chord);
}

} // namespace tungsten::photon
