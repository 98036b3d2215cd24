#pragma once
// BallSlice.h for a register of rays: at one length of each frame, and a point drawn inside each frame.

#include "photon/primitives/balls/SharedLanes.h"

namespace tungsten::photon {

/// Scattering at the centre, or a light's own.
inline Batch leavingBall(const LaneRecord& record, const Lanes3& last) {
    if (record.flights->onSurface) {
        const auto& normals = record.flights->directions;
        return xsimd::select(last.dot(normals[2]) > 0.0f, xsimd::max(last.dot(normals[0]), Batch(0.0f)) * InvPi,
                             Batch(0.0f));
    }
    return record.isotropic ? Batch(1.0f) : henyeyGreenstein(record.g, Lanes3(record.flights->directions[1]), last);
}

/// What a ball counts of a path that volumes make too, (16): `scattered` at its centre into the last flight.
inline Batch ballWeight(const LaneRecord& record, const LaneRays& rays, const Lanes3& last, const Batch& length,
                        const Batch& scattered) {
    const auto& w = record.flights->directions;
    const Batch volume = scattered * volumeJacobian(Lanes3(w[0]), Lanes3(w[1]), last, rays.direction, record.warped);
    const Batch ball = record.pdfs * length * length * lengthPerLength(last, rays.direction, record.warped);
    return shareOf(ball, volume);
}
/// The ball's weight inside a gate.
inline Batch ballWeight(const LaneRecord& record, const LaneRays& rays, const BallGateView& lit,
                        const SharedPathLanes& path, const Batch& scattered) {
    if (!record.weighsPlaces()) return ballWeight(record, rays, path.last, path.t3, scattered);
    const float before = record.flights->lengths[0] + record.flights->lengths[1];
    const Batch soon = record.times.start(0) - rays.lag + before, late = record.times.start(1) - rays.lag + before;
    return ballShareInGate(lit, Batch(record.pdfs), scattered * placedByVolume(record, rays, path, soon, late));
}

/// At one path length, or a random one of each frame.
class BallSliceLanes {
  public:
    /// emit(frame, reach)
    template <typename Emit>
    void intersect(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        const BallViewLanes view(rays);
        const FrameRange range = view.frames(record, rays);
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            const Batch s = record.residual(rays, frame);
            const auto add = [&](const Batch& length, const Batch& along, const Batch& jacobian) {
                const LaneMask met = rays.seen && jacobian > 0.0f && along >= rays.start && along < rays.end;
                if (xsimd::any(met))
                    emit(frame, LaneHit{met, along, length + along, factor(record, rays, length, along, jacobian)});
            };
            if (record.warped) {
                const Batch beyond = xsimd::max(s - view.foot, Batch(1e-30f)), h = view.distanceFromRay;
                const Batch jacobian = 0.5f * (beyond * beyond + h * h);
                add(jacobian / beyond, view.foot + view.turn(s), jacobian);
            } else {
                const Batch half = xsimd::select(s > view.distanceFromRay, view.halfChord(s), Batch(0.0f));
                add(s, view.foot - half, s * half);
                add(s, view.foot + half, s * half);
            }
        }
    }

  private:
    /// (11), and the share of (16).
    [[nodiscard]] static Batch factor(const LaneRecord& record, const LaneRays& rays, const Batch& length,
                                      const Batch& along, const Batch& jacobian) {
        const Lanes3& c = rays.direction;
        const Lanes3 last = (rays.toOrigin + c * along) * (1.0f / length);
        const Batch first = leavingBall(record, last);
        const Batch weight = first * record.towardsCamera(last, rays) / jacobian;
        return record.flights->shared ? weight * ballWeight(record, rays, last, length, first) : weight;
    }
};

/// At a point drawn inside each frame, as BallGate draws it: (13).
class BallGateLanes {
  public:
    /// emit(frame, reach)
    template <typename Emit>
    void intersect(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        const BallViewLanes view(rays);
        const FrameRange range = view.frames(record, rays);
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            const Batch soon = record.times.start(frame) - rays.lag, late = record.times.start(frame + 1) - rays.lag;
            draw(record, rays, BallGateView(rays, soon, late, record.warped), frame, emit);
        }
    }

  private:
    template <typename Emit>
    static void draw(const LaneRecord& record, const LaneRays& rays, const BallGateView& lit, int frame, Emit&& emit) {
        const auto& [view, one, other] = lit;
        const Batch& h = view.distanceFromRay;
        const Batch angles = lit.angles();
        const LaneMask met = rays.seen && angles > 0.0f && h > 0.0f;
        if (!xsimd::any(met)) return;
        const Batch turned = record.random(0, rays, frame) * angles;
        const LaneMask first = turned < one.angle;
        const Batch from = xsimd::select(first, one.from, other.from), to = xsimd::select(first, one.to, other.to);
        const Batch slope = xsimd::tan(turned - xsimd::select(first, Batch(0.0f), one.angle));
        const Batch beside = xsimd::min(xsimd::max(h * (from + h * slope) / (h - from * slope), from), to);
        const Batch length = xsimd::sqrt(h * h + beside * beside), along = view.foot + beside;
        const Lanes3 last = (rays.toOrigin + rays.direction * along) * (1.0f / length);
        const Batch scattered = leavingBall(record, last);
        Batch factor = scattered * record.towardsCamera(last, rays) * angles / h;
        if (record.flights->shared) {
            const auto& before = record.flights->lengths;
            const SharedPathLanes path{last, Batch(before[0]), Batch(before[1]), length, along};
            factor *= ballWeight(record, rays, lit, path, scattered);
        }
        emit(frame, LaneHit{met && length >= record.flights->reach, along, length + along, factor});
    }
};

} // namespace tungsten::photon
