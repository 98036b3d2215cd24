#pragma once
// HypervolumeSlice.h for a register of rays.

#include "photon/primitives/sliced/ChordLanes.h"

namespace tungsten::photon {

/// At one path length, or a random one of each frame.
class HypervolumeLanes {
  public:
    explicit HypervolumeLanes(const SliceRecord& flights)
        : edges_(edge(flights, 0), edge(flights, 1), edge(flights, 2)) {
        for (size_t i = 0; i < 3; ++i) perResidual_[i] = -flights.directions[3].dot(edges_.rows[i]);
    }
    /// emit(frame, reach)
    template <typename Emit>
    void intersect(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        if (!usable()) return;
        const Vec3f& last = record.flights->directions[3];
        const Lanes3 change = rays.direction + Lanes3(last * record.warp());
        ChordLanes<4> chord{};
        std::array<Batch, 3> start;
        for (size_t i = 0; i < 3; ++i) {
            start[i] = rays.toOrigin.dot(edges_.rows[i]);
            chord.slope[i] = change.dot(edges_.rows[i]);
        }
        chord.slope[3] = -record.warp() - chord.slope[0] - chord.slope[1] - chord.slope[2];
        const Batch factor = record.towardsCamera(Lanes3(last), rays) * (1.0f / edges_.determinant);
        const FrameRange range = framesOf(record.times, rays.seen, rays.soonest(record.warped), Batch(Infinity));
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            const Batch s = record.residual(rays, frame);
            for (size_t i = 0; i < 3; ++i) chord.offset[i] = start[i] + s * perResidual_[i];
            chord.offset[3] = s - chord.offset[0] - chord.offset[1] - chord.offset[2];
            chord.start = rays.start;
            chord.end = rays.end;
            chord.keepFlights(record.reach);
            const LaneMask met = rays.seen && chord.holds();
            if (xsimd::any(met)) emit(frame, chord.hit(record, met, factor, record.random(1, rays, frame)));
        }
    }

  private:
    /// Beyond the last direction.
    [[nodiscard]] static Vec3d edge(const SliceRecord& flights, size_t i) {
        return Vec3d(flights.directions[i]) - Vec3d(flights.directions[3]);
    }
    [[nodiscard]] bool usable() const { return edges_.determinant > LeastLaneDeterminant; }
    ReciprocalBasis3 edges_;
    std::array<float, 3> perResidual_{};
};

} // namespace tungsten::photon
