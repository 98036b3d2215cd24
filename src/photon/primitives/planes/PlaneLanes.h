#pragma once
// PlaneCrossing.h for a register of rays.

#include "photon/primitives/sliced/SliceLanes.h"

namespace tungsten::photon {

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
