#pragma once
// BallSlice.h for a register of rays: at one length of each frame, and a point drawn inside each frame.

#include "photon/primitives/volumes/VolumeLanes.h"

namespace tungsten::photon {

/// A ball's centre as a register of rays sees it.
struct BallViewLanes {
    Batch foot, distanceFromRay, distanceFromOrigin;

    explicit BallViewLanes(const LaneRays& rays)
        : foot(-rays.toOrigin.dot(rays.direction)), distanceFromRay(rays.distance()),
          distanceFromOrigin(rays.originDistance()) {}
    [[nodiscard]] Batch turn(const Batch& s) const {
        return xsimd::select(s > distanceFromOrigin,
                             (s - distanceFromOrigin) * (s + distanceFromOrigin) / (2.0f * (s - foot)), Batch(0.0f));
    }
    [[nodiscard]] Batch halfChord(const Batch& radius) const {
        return xsimd::sqrt(xsimd::max((radius - distanceFromRay) * (radius + distanceFromRay), Batch(0.0f)));
    }
    [[nodiscard]] FrameRange frames(const LaneRecord& record, const LaneRays& rays) const {
        return framesOf(record.times, rays.seen, record.warped ? distanceFromOrigin : distanceFromRay, Batch(Infinity));
    }
};

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
inline Batch ballShare(const LaneRecord& record, const LaneRays& rays, const Lanes3& last, const Batch& length,
                       const Batch& scattered) {
    const auto& w = record.flights->directions;
    const Batch volume = scattered * volumeJacobian(Lanes3(w[0]), Lanes3(w[1]), last, rays.direction, record.warped);
    const Batch ball = record.pdfs * length * length * lengthPerLength(last, rays.direction, record.warped);
    return shareOf(ball, volume);
}

/// At one path length, or a random one of each frame.
class BallSliceLanes {
  public:
    /// emit(frame, reach)
    template <typename Emit>
    void meet(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        const BallViewLanes view(rays);
        const FrameRange range = view.frames(record, rays);
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            const Batch s = record.residual(rays, frame);
            const auto add = [&](const Batch& length, const Batch& along, const Batch& jacobian) {
                const LaneMask met = rays.seen && jacobian > 0.0f && along >= rays.start && along < rays.end;
                if (xsimd::any(met))
                    emit(frame, LaneReach{met, along, length + along, factor(record, rays, length, along, jacobian)});
            };
            if (record.warped) {
                const Lanes3 d = rays.direction * s + rays.toOrigin;
                const Batch along = view.turn(s);
                add(s - along, along, xsimd::select(s > view.distanceFromOrigin, 0.5f * d.dot(d), Batch(0.0f)));
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
        return record.flights->shared ? weight * ballShare(record, rays, last, length, first) : weight;
    }
};

/// At a point drawn inside each frame, as BallGate draws it: (13).
class BallGateLanes {
  public:
    /// emit(frame, reach)
    template <typename Emit>
    void meet(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        const BallViewLanes view(rays);
        const FrameRange range = view.frames(record, rays);
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            const Batch soon(record.times.start(frame)), late(record.times.start(frame + 1));
            if (!(record.times.start(frame + 1) > 0.0f)) continue;
            Interval one = record.warped ? clipped(view, rays, view.turn(soon) - view.foot, view.turn(late) - view.foot)
                                         : Interval{};
            Interval other{};
            if (!record.warped) {
                const Batch inner = view.halfChord(xsimd::max(soon, Batch(0.0f)));
                const Batch outer = xsimd::select(late > view.distanceFromRay, view.halfChord(late), Batch(0.0f));
                one = clipped(view, rays, -outer, -inner);
                other = clipped(view, rays, inner, outer);
            }
            draw(record, rays, view, one, other, frame, emit);
        }
    }

  private:
    /// Along the ray from the foot, and seen from the centre.
    struct Interval {
        Batch from = Batch(0.0f), to = Batch(0.0f), angle = Batch(0.0f);
    };
    [[nodiscard]] static Interval clipped(const BallViewLanes& view, const LaneRays& rays, const Batch& from,
                                          const Batch& to) {
        Interval i{xsimd::max(from, rays.start - view.foot), xsimd::min(to, rays.end - view.foot), Batch(0.0f)};
        const LaneMask holds = i.from < i.to;
        if (!xsimd::any(holds)) return i;
        const Batch& h = view.distanceFromRay;
        i.angle = xsimd::select(holds, xsimd::atan2(h * (i.to - i.from), h * h + i.from * i.to), Batch(0.0f));
        return i;
    }
    template <typename Emit>
    static void draw(const LaneRecord& record, const LaneRays& rays, const BallViewLanes& view, const Interval& one,
                     const Interval& other, int frame, Emit&& emit) {
        const Batch& h = view.distanceFromRay;
        const Batch angles = one.angle + other.angle;
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
        if (record.flights->shared) factor *= ballShare(record, rays, last, length, scattered);
        emit(frame, LaneReach{met && length >= record.flights->reach, along, length + along, factor});
    }
};

} // namespace tungsten::photon
