#pragma once
// Photon planes: where a camera ray crosses one, and registers of rays (docs/photon-primitives.md, section 2.3).

#include "photon/primitives/sliced/CameraRay.h"
#include "photon/primitives/sliced/SliceLanes.h"

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
    /// transmittance; otherwise short flights, E = 1.
    [[nodiscard]] Real weight(const Coefficients<Real>& medium, bool longFlights = true) const {
        return collisions(medium.sigmaS, 2) / jacobian *
               std::exp(-medium.sigmaT * ((longFlights ? flightLength() : 0) + alongRay));
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

/// PlaneCrossing for a register of rays.
class PlaneLanes {
  public:
    explicit PlaneLanes(const SliceRecord& flights) : edges_(flights.directions[0], flights.directions[1]) {}
    /// emit(frame, reach)
    template <typename Emit>
    void intersect(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        const Batch across = rays.direction.dot(edges_.normal), jacobian = xsimd::abs(across);
        const Batch t = -(rays.toOrigin.dot(edges_.normal) / across);
        const Lanes3 p = rays.toOrigin + rays.direction * t;
        const Batch t1 = p.dot(edges_.first), t2 = p.dot(edges_.second);
        const LaneMask met = rays.seen && jacobian > LeastLaneDeterminant && t1 >= 0.0f && t1 < record.reach &&
                             t2 >= 0.0f && t >= rays.start && t < rays.end;
        if (!xsimd::any(met)) return;
        const Batch arrival = t1 + t2 + record.warp() * t + rays.lag;
        LaneHit reach{met,
                      t,
                      t1 + t2 + t,
                      record.towardsCamera(Lanes3(record.flights->directions[1]), rays) / jacobian,
                      {t1, t2}};
        const FrameRange range = framesOf(record.times, met, arrival, arrival);
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            reach.met = met && arrival >= record.times.start(frame) && arrival < record.times.start(frame + 1);
            if (xsimd::any(reach.met)) emit(frame, reach);
        }
    }

  private:
    ReciprocalBasis2 edges_;
};

} // namespace tungsten::photon
