#pragma once
// Photon balls: every point of a camera ray is reached from a vertex; a path length or a gate chooses among them
// (docs/photon-primitives.md, section 2.5).

#include "photon/primitives/sliced/CameraRay.h"
#include "photon/primitives/sliced/SharedLanes.h"

namespace tungsten::photon {

/// The last flight, from a ball's centre to the camera ray.
template <typename Real>
struct BallHit {
    Real length, alongRay;
    Real jacobian; ///< of a slice: t^2 |w . c + warp|

    /// (11) without the power and both phase functions: sigma_s E T / J.
    [[nodiscard]] Real weight(const Coefficients<Real>& medium, bool longFlights = true) const {
        return medium.sigmaS / jacobian * std::exp(-medium.sigmaT * ((longFlights ? length : 0) + alongRay));
    }
};

/// A ball's centre as a ray sees it.
template <typename Real>
struct BallView {
    Vector<Real> offset;  ///< centre - origin
    Real toFoot;          ///< along the ray, to the point next to the centre
    Real distanceFromRay; ///< of the centre
    Real distanceFromOrigin;

    BallView(const Vector<Real>& centre, const CameraRay<Real>& sight)
        : offset(centre - sight.origin), toFoot(offset.dot(sight.direction)),
          distanceFromRay(offset.cross(sight.direction).length()), distanceFromOrigin(offset.length()) {}

    /// What a warped path of this length is longer than the way straight back from the foot.
    [[nodiscard]] Real beyondFoot(Real residual) const { return residual - toFoot; }
    /// Where a warped path of this length from the centre over the ray to its origin turns, from the foot: however far
    /// the origin, only beyondFoot() is a difference. Minus infinity where the path is too short for any point.
    [[nodiscard]] Real turn(Real residual) const {
        const Real beyond = beyondFoot(residual), h = distanceFromRay;
        return beyond > 0 ? (beyond - h) * (1 + h / beyond) / 2 : -std::numeric_limits<Real>::infinity();
    }
    /// Half the part of the ray inside a sphere about the centre; 0 outside.
    [[nodiscard]] Real halfChord(Real radius) const {
        return radius > distanceFromRay ? std::sqrt((radius - distanceFromRay) * (radius + distanceFromRay)) : 0;
    }
    /// The chord's ends toFoot -+ half, for a sphere of this radius, without cancellation.
    [[nodiscard]] std::array<Real, 2> chordEnds(Real radius, Real half) const {
        const Real power = (distanceFromOrigin - radius) * (distanceFromOrigin + radius);
        if (toFoot > 0) return {power / (toFoot + half), toFoot + half};
        return {toFoot - half, half - toFoot > 0 ? -power / (half - toFoot) : 0};
    }
};

/// At most two reaches.
template <typename Real>
struct BallSlice {
    std::array<BallHit<Real>, 2> hits{};
    int count = 0;
};

/// `residual` as for volumes.
template <typename Real>
BallSlice<Real> sliceBall(const Vector<Real>& centre, const CameraRay<Real>& sight, Real residual) {
    const BallView<Real> view(centre, sight);
    BallSlice<Real> slice;
    const auto add = [&](Real length, Real t, Real jacobian) {
        if (jacobian > 0 && sight.holds(t)) slice.hits[size_t(slice.count++)] = {length, t, jacobian};
    };
    if (sight.warped) {
        const Real beyond = view.beyondFoot(residual), h = view.distanceFromRay;
        const Real jacobian = (beyond * beyond + h * h) / 2;
        if (beyond > 0) add(jacobian / beyond, view.toFoot + view.turn(residual), jacobian);
    } else {
        const Real half = view.halfChord(residual);
        if (!(half > 0)) return slice;
        for (const Real t : view.chordEnds(residual, half)) add(residual, t, residual * half);
    }
    return slice;
}

/// The part of the ray that a ball lights inside a gate: at most two intervals, in order.
template <typename Real>
struct BallGate {
    BallView<Real> view;
    std::array<Real, 2> start{}, end{}; ///< along the ray, from the foot
    std::array<Real, 2> angle{};        ///< seen from the centre; 0 for an empty interval

    [[nodiscard]] Real angles() const { return angle[0] + angle[1]; }
    /// Equiangular: density along the ray distanceFromRay / (angles() t^2), t from the centre. u in [0, 1).
    [[nodiscard]] BallHit<Real> sample(Real u) const {
        Real turned = u * angles();
        const size_t chosen = turned < angle[0] ? 0 : 1;
        if (chosen == 1) turned -= angle[0];
        const Real h = view.distanceFromRay, from = start[chosen], slope = std::tan(turned);
        const Real ahead = std::clamp(h * (from + h * slope) / (h - from * slope), from, end[chosen]);
        return {std::hypot(h, ahead), view.toFoot + ahead, 0};
    }
    /// (13) without power, both phase functions and the gate's width, at a sample: sigma_s E T angles / h.
    [[nodiscard]] Real weight(const BallHit<Real>& reach, const Coefficients<Real>& medium,
                              bool longFlights = true) const {
        return medium.sigmaS * angles() / view.distanceFromRay *
               std::exp(-medium.sigmaT * ((longFlights ? reach.length : 0) + reach.alongRay));
    }
};

template <typename Real>
BallGate<Real> gateBall(const Vector<Real>& centre, const CameraRay<Real>& sight, const ResidualGate<Real>& gate) {
    BallGate<Real> lit{BallView<Real>(centre, sight)};
    const BallView<Real>& view = lit.view;
    const Real h = view.distanceFromRay;
    if (!(h > 0)) return lit;
    const auto add = [&](size_t i, Real from, Real to) {
        const Real a = lit.start[i] = std::max(from, sight.start - view.toFoot);
        const Real b = lit.end[i] = std::min(to, sight.end - view.toFoot);
        if (!(a < b)) return;
        lit.angle[i] = std::isinf(b) ? std::atan2(h, a) : std::atan2(h * (b - a), h * h + a * b);
    };
    if (sight.warped) {
        add(0, view.turn(gate.least), std::isinf(gate.most) ? gate.most : view.turn(gate.most));
    } else if (gate.most > h) {
        const Real outer = std::isinf(gate.most) ? gate.most : view.halfChord(gate.most);
        const Real inner = view.halfChord(std::max(gate.least, Real(0)));
        if (inner > 0) {
            add(0, -outer, -inner);
            add(1, inner, outer);
        } else {
            add(0, -outer, outer);
        }
    }
    return lit;
}

// ---- For a register of rays

/// Scattering at the centre, or a light's own.
inline Batch leavingBall(const LaneRecord& record, const Lanes3& last) {
    if (record.flights->onSurface) {
        const auto& normals = record.flights->directions;
        return xsimd::select(last.dot(normals[2]) > 0.0f, xsimd::max(last.dot(normals[0]), Batch(0.0f)) * InvPi,
                             Batch(0.0f));
    }
    switch (record.leaving) {
    case LaneRecord::Leaving::Evenly:
        return Batch(1.0f);
    case LaneRecord::Leaving::Cosine: {
        const Batch cosine = last.dot(record.flights->directions[0]);
        return xsimd::select(cosine >= record.leastCosine, xsimd::max(cosine, Batch(0.0f)), Batch(0.0f));
    }
    case LaneRecord::Leaving::Phase:
        break;
    }
    return henyeyGreenstein(record.g, Lanes3(record.flights->directions[1]), last);
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
