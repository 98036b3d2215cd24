#pragma once
// Where a camera ray crosses a photon plane (docs/photon-primitives.md, section 2.3).

#include "photon/primitives/sliced/CameraRay.h"

#include <optional>

namespace tungsten::photon {

/// Two collapsed flights and the camera ray meet.
template <typename Real>
struct PlaneCrossing {
    std::array<Real, 2> lengths; ///< of the flights
    Real alongRay;
    Real jacobian; ///< |w1 w2 c|

    [[nodiscard]] Real flightLength() const { return lengths[0] + lengths[1]; }
    /// (5) without the power and the phase function at the end: sigma_s^2 E T / J. `longFlights`: E is their
    /// transmittance; otherwise short flights, E = 1. `before`: of the ray, not counted in T.
    [[nodiscard]] Real weight(const Coefficients<Real>& medium, Real before = 0, bool longFlights = true) const {
        return collisions(medium.sigmaS, 2) / jacobian *
               std::exp(-medium.sigmaT * ((longFlights ? flightLength() : 0) + alongRay - before));
    }
};

/// None where the plane is seen edge on to `least`, or the ray passes beside it.
template <typename Real>
std::optional<PlaneCrossing<Real>> crossPlane(const Vector<Real>& base, const std::array<Vector<Real>, 2>& directions,
                                              const CameraRay<Real>& sight, Real least = LeastDeterminant<Real>) {
    const LinearSystem<Real> system(directions[0], directions[1], -sight.direction);
    const Real jacobian = std::abs(system.determinant());
    if (!(jacobian > least)) return std::nullopt;
    const auto [t1, t2, t] = system.solve(sight.origin - base);
    if (!(t1 >= 0 && t2 >= 0 && sight.holds(t))) return std::nullopt;
    return PlaneCrossing<Real>{{t1, t2}, t, jacobian};
}

} // namespace tungsten::photon
