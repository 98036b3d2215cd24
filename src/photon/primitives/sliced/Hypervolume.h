#pragma once
// Photon hypervolumes: four collapsed flights at one path length (docs/photon-primitives.md, section 2.6).

#include "photon/primitives/sliced/CameraRay.h"
#include "photon/primitives/sliced/SliceLanes.h"

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

// ---- For a register of rays

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
