#pragma once
// VolumeBallMis.h for a register of rays.

#include "photon/primitives/sliced/SliceLanes.h"

namespace tungsten::photon {

/// Change of path length along the ray.
inline Batch lengthPerLength(const Lanes3& last, const Lanes3& ray, bool warped) {
    const Lanes3 sum = last + ray;
    return warped ? 0.5f * sum.dot(sum) : xsimd::abs(last.dot(ray));
}
/// a / (a + b)
inline Batch shareOf(const Batch& a, const Batch& b) {
    return a / xsimd::max(a + b, Batch(1e-37f));
}

/// Jacobian of volumes, at flights along these directions that end on the ray: Volume.h.
inline Batch volumeJacobian(const Lanes3& first, const Lanes3& second, const Lanes3& last, const Lanes3& ray,
                            bool warped) {
    return xsimd::abs(warped ? (first + ray).dot((second + ray).cross(last + ray))
                             : (first - last).dot((second - last).cross(ray)));
}
/// Density of two free flights of these lengths.
inline Batch flightPdfs(const LaneRecord& record, const Batch& t1, const Batch& t2) {
    return record.grey ? record.sigmaT.x * record.sigmaT.x * xsimd::exp(-record.sigmaT.x * (t1 + t2))
                       : record.flightPdf(t1) * record.flightPdf(t2);
}

/// A ball's centre as a register of rays sees it.
struct BallViewLanes {
    Batch foot, distanceFromRay;

    explicit BallViewLanes(const LaneRays& rays)
        : foot(-rays.toOrigin.dot(rays.direction)), distanceFromRay(rays.distance()) {}
    /// BallView::turn.
    [[nodiscard]] Batch turn(const Batch& s) const {
        // Before any way that light can take it lies far behind.
        const Batch beyond = xsimd::max(s - foot, Batch(1e-30f)), h = distanceFromRay;
        return 0.5f * (beyond - h) * (1.0f + h / beyond);
    }
    [[nodiscard]] Batch halfChord(const Batch& radius) const {
        return xsimd::sqrt(xsimd::max((radius - distanceFromRay) * (radius + distanceFromRay), Batch(0.0f)));
    }
    [[nodiscard]] FrameRange frames(const LaneRecord& record, const LaneRays& rays) const {
        return framesOf(record.times, rays.seen, rays.soonest(record.warped), Batch(Infinity));
    }
};

/// The part of the rays that a ball lights inside a gate.
struct BallGateView {
    /// Along the ray from the foot, and seen from the centre.
    struct Interval {
        Batch from = Batch(0.0f), to = Batch(0.0f), angle = Batch(0.0f);
    };
    BallViewLanes view;
    Interval one, other;

    /// `soon`, `late`: path lengths left at the centre.
    BallGateView(const LaneRays& rays, const Batch& soon, const Batch& late, bool warped) : view(rays) {
        if (warped) {
            one = clipped(rays, view.turn(soon), view.turn(late));
            return;
        }
        const Batch inner = view.halfChord(xsimd::max(soon, Batch(0.0f)));
        const Batch outer = xsimd::select(late > view.distanceFromRay, view.halfChord(late), Batch(0.0f));
        one = clipped(rays, -outer, -inner);
        other = clipped(rays, inner, outer);
    }
    [[nodiscard]] Batch angles() const { return one.angle + other.angle; }

  private:
    [[nodiscard]] Interval clipped(const LaneRays& rays, const Batch& from, const Batch& to) const {
        Interval i{xsimd::max(from, rays.start - view.foot), xsimd::min(to, rays.end - view.foot), Batch(0.0f)};
        const LaneMask holds = i.from < i.to;
        if (!xsimd::any(holds)) return i;
        const Batch& h = view.distanceFromRay;
        i.angle = xsimd::select(holds, xsimd::atan2(h * (i.to - i.from), h * h + i.from * i.to), Batch(0.0f));
        return i;
    }
};

/// Flights that meet the ray at `alongRay`.
struct SharedPathLanes {
    Lanes3 last;
    Batch t1, t2, t3, alongRay;
};

/// Density with which a volume draws this point of the ray inside a gate times its determinant; 0 where it is left out.
/// `soon`, `late`: path lengths left at the volume's base. What is in the way does not count, as balls do not know it.
inline Batch placedByVolume(const LaneRecord& record, const LaneRays& rays, const SharedPathLanes& path,
                            const Batch& soon, const Batch& late) {
    const Lanes3 first(record.flights->directions[0]), second(record.flights->directions[1]);
    const std::array<Lanes3, 3> rows{second.cross(path.last), path.last.cross(first), first.cross(second)};
    const Batch determinant = first.dot(rows[0]), jacobian = xsimd::abs(determinant);
    const LaneMask usable = jacobian > LeastLaneDeterminant;
    const Batch inverse = 1.0f / xsimd::select(usable, determinant, Batch(1.0f));
    ChordLanes<3> chord{{path.t1, path.t2, path.t3}, {}, rays.start, rays.end};
    for (size_t i = 0; i < 3; ++i) {
        chord.slope[i] = rays.direction.dot(rows[i]) * inverse;
        chord.offset[i] -= chord.slope[i] * path.alongRay;
    }
    chord.keepFlights(Infinity);
    chord.keep(chord.offsetSum(), chord.slopeSum() + record.warp(), soon, late);
    const Batch rise = chord.slopeSum() + 1.0f, length = xsimd::max(chord.end - chord.start, Batch(1e-30f));
    const Batch fall = meanComponent(record.sigmaT) * xsimd::abs(rise);
    const Batch fromBright = xsimd::select(rise >= 0.0f, path.alongRay - chord.start, chord.end - path.alongRay);
    const Batch integral = length * meanOfFall(fall * length); // over the light at the bright end
    const Batch density = xsimd::exp(-fall * xsimd::max(fromBright, Batch(0.0f))) / integral;
    return xsimd::select(usable, jacobian * density, Batch(0.0f));
}

/// The ball's share of a path inside a gate: (16) times the densities along the ray, without the squared last length of
/// both. `volume`: density of the last direction times placedByVolume(); `pdfs`: of the flights before.
inline Batch ballShareInGate(const BallGateView& lit, const Batch& pdfs, const Batch& volume) {
    return shareOf(pdfs * lit.view.distanceFromRay, volume * lit.angles());
}

} // namespace tungsten::photon
