#pragma once
// HypervolumeSlice.h for a register of rays.

#include "photon/primitives/sliced/ChordLanes.h"

namespace tungsten::photon {

/// At one path length, or a random one of each frame.
class HypervolumeLanes {
  public:
    explicit HypervolumeLanes(const CollapsedFlights& flights) {
        const auto& w = flights.directions;
        const Vec3f a = w[0] - w[3], b = w[1] - w[3], c = w[2] - w[3];
        rows_ = {b.cross(c), c.cross(a), a.cross(b)};
        const float determinant = a.dot(rows_[0]);
        jacobian_ = std::abs(determinant);
        if (!usable()) return;
        for (size_t i = 0; i < 3; ++i) {
            rows_[i] /= determinant;
            perResidual_[i] = -w[3].dot(rows_[i]);
        }
    }
    /// emit(frame, reach)
    template <typename Emit>
    void meet(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        if (!usable()) return;
        const Vec3f& last = record.flights->directions[3];
        const Lanes3 change = rays.direction + Lanes3(last * record.warp());
        ChordLanes<4> chord{};
        std::array<Batch, 3> start;
        for (size_t i = 0; i < 3; ++i) {
            start[i] = rays.toOrigin.dot(rows_[i]);
            chord.slope[i] = change.dot(rows_[i]);
        }
        chord.slope[3] = -record.warp() - chord.slope[0] - chord.slope[1] - chord.slope[2];
        const Batch factor = record.towardsCamera(Lanes3(last), rays) * (1.0f / jacobian_);
        const Batch least = record.warped ? rays.originDistance() : rays.distance();
        const FrameRange range = framesOf(record.times, rays.seen, least, Batch(Infinity));
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            const Batch s = record.residual(rays, frame);
            for (size_t i = 0; i < 3; ++i) chord.offset[i] = start[i] + s * perResidual_[i];
            chord.offset[3] = s - chord.offset[0] - chord.offset[1] - chord.offset[2];
            chord.start = rays.start;
            chord.end = rays.end;
            chord.keepFlights(record.reach);
            const LaneMask met = rays.seen && s > 0.0f && chord.holds();
            if (xsimd::any(met)) emit(frame, chord.reach(record, met, factor, record.random(1, rays, frame)));
        }
    }

  private:
    [[nodiscard]] bool usable() const { return jacobian_ > LeastLaneDeterminant; }
    std::array<Vec3f, 3> rows_;
    std::array<float, 3> perResidual_{};
    float jacobian_;
};

} // namespace tungsten::photon
