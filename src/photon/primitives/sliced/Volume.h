#pragma once
// Photon volumes: a slice at one path length, and the chord inside a gate (docs/photon-primitives.md, section 2.4).

#include "photon/primitives/sliced/CameraRay.h"
#include "photon/primitives/sliced/SharedLanes.h"

#include <optional>

namespace tungsten::photon {

/// Three collapsed flights and the camera ray meet, with a given total length.
template <typename Real>
struct VolumeSlice {
    std::array<Real, 3> lengths; ///< of the flights
    Real alongRay;
    Real jacobian;

    [[nodiscard]] Real flightLength() const { return lengths[0] + lengths[1] + lengths[2]; }
    /// (7) without the power and the phase function at the end: sigma_s^3 E T / J, as for planes.
    [[nodiscard]] Real weight(const Coefficients<Real>& medium, bool longFlights = true) const {
        return collisions(medium.sigmaS, 3) / jacobian *
               std::exp(-medium.sigmaT * ((longFlights ? flightLength() : 0) + alongRay));
    }
};

/// Determinant of space and time by the three lengths and the ray's: (8), by sums or differences of unit vectors.
template <typename Real>
Real volumeJacobian(const std::array<Vector<Real>, 3>& w, const Vector<Real>& ray, bool warped) {
    return std::abs(warped ? determinant<Real>(w[0] + ray, w[1] + ray, w[2] + ray)
                           : determinant<Real>(w[0] - w[2], w[1] - w[2], ray));
}

/// `residual`: path length left at the base, up to the ray's point or, warped, its origin. None where the determinant
/// is at most `least`, or the ray passes beside the slice.
template <typename Real>
std::optional<VolumeSlice<Real>> sliceVolume(const Vector<Real>& base, const std::array<Vector<Real>, 3>& w,
                                             const CameraRay<Real>& sight, Real residual,
                                             Real least = LeastDeterminant<Real>) {
    if (!(residual > 0)) return std::nullopt;
    const Vector<Real>& c = sight.direction;
    const Vector<Real> toOrigin = sight.origin - base;
    const LinearSystem<Real> system = sight.warped ? LinearSystem<Real>(w[0] + c, w[1] + c, w[2] + c)
                                                   : LinearSystem<Real>(w[0] - w[2], w[1] - w[2], -c);
    VolumeSlice<Real> slice{};
    slice.jacobian = std::abs(system.determinant());
    if (!(slice.jacobian > least)) return std::nullopt;
    if (sight.warped) {
        slice.lengths = system.solve(toOrigin + c * residual);
        slice.alongRay = residual - slice.flightLength();
        const auto& t = slice.lengths;
        const Vector<Real> miss = w[0] * t[0] + w[1] * t[1] + w[2] * t[2] - toOrigin - c * slice.alongRay;
        constexpr Real Accuracy = Real(1e-4);
        if (!(miss.length() <= Accuracy * residual)) return std::nullopt;
    } else {
        const auto [t1, t2, t] = system.solve(toOrigin - w[2] * residual);
        slice.lengths = {t1, t2, residual - t1 - t2};
        slice.alongRay = t;
    }
    const auto& [t1, t2, t3] = slice.lengths;
    if (!(t1 >= 0 && t2 >= 0 && t3 >= 0 && sight.holds(slice.alongRay))) return std::nullopt;
    return slice;
}

template <typename Real>
using VolumeChord = Chord<Real, 3>;

/// The part of the ray inside the volume, for any time; its jacobian is |w1 w2 w3|.
template <typename Real>
std::optional<VolumeChord<Real>> volumeChord(const Vector<Real>& base, const std::array<Vector<Real>, 3>& w,
                                             const CameraRay<Real>& sight, Real least = LeastDeterminant<Real>) {
    const LinearSystem<Real> system(w[0], w[1], w[2]);
    const Real jacobian = std::abs(system.determinant());
    if (!(jacobian > least)) return std::nullopt;
    VolumeChord<Real> chord{system.solve(sight.origin - base), system.solve(sight.direction), jacobian, sight.start,
                            sight.end};
    chord.keepFlights(unboundedFlights<Real, 3>());
    return chord.empty() ? std::nullopt : std::optional(chord);
}

// ---- For a register of rays

/// What a volume counts of a path that balls make too, (16): of this Jacobian, at flights of these lengths.
inline Batch volumeWeight(const LaneRecord& record, const LaneRays& rays, const Batch& jacobian, const Batch& t1,
                          const Batch& t2, const Batch& t3) {
    const Lanes3 last(record.flights->directions[2]);
    return shareOf(record.phasePdf * jacobian,
                   flightPdfs(record, t1, t2) * t3 * t3 * lengthPerLength(last, rays.direction, record.warped));
}
/// The volume's weight inside a gate.
inline Batch volumeWeightInGate(const LaneRecord& record, const LaneRays& rays, const LaneHit& hit) {
    const auto& [t1, t2, t3, none] = hit.lengths;
    const auto& w = record.flights->directions;
    const Batch soon = record.times.start(0) - rays.lag, late = record.times.start(1) - rays.lag, before = t1 + t2;
    LaneRays fromCentre = rays;
    fromCentre.toOrigin = rays.toOrigin - (Lanes3(w[0]) * t1 + Lanes3(w[1]) * t2);
    const BallGateView lit(fromCentre, soon - before, late - before, record.warped);
    const Batch volume =
        record.phasePdf * placedByVolume(record, rays, {Lanes3(w[2]), t1, t2, t3, hit.alongRay}, soon, late);
    return 1.0f - ballShareInGate(lit, flightPdfs(record, t1, t2), volume);
}

/// At one path length, or a random one of each frame. For one ray all four lengths are linear in the path length.
class VolumeSliceLanes {
  public:
    explicit VolumeSliceLanes(const SliceRecord& flights)
        : edges_(flights.directions[0] - flights.directions[2], flights.directions[1] - flights.directions[2]) {}
    /// emit(frame, reach)
    template <typename Emit>
    void intersect(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        const Line line = record.warped ? warpedLine(record, rays) : unwarpedLine(record, rays);
        const LaneMask seen = rays.seen && line.jacobian > LeastLaneDeterminant;
        if (!xsimd::any(seen)) return;
        const FrameRange range = frames(record, rays, line, seen);
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            const Batch s = record.residual(rays, frame);
            const Batch t1 = line.lengths.length(0, s), t2 = line.lengths.length(1, s), t3 = line.lengths.length(2, s);
            const Batch along = line.lengths.length(3, s);
            LaneMask met = seen && t1 >= 0.0f && t1 < record.reach && t2 >= 0.0f && t3 >= 0.0f && along >= rays.start &&
                           along < rays.end;
            if (!xsimd::any(met)) continue;
            if (record.warped) met = met && closes(record, rays, {t1, t2, t3}, along);
            emit(frame,
                 LaneHit{
                     met, along, t1 + t2 + t3 + along, factor(record, rays, line.jacobian, t1, t2, t3), {t1, t2, t3}});
        }
    }

  private:
    /// Lengths of the three flights and along the ray.
    struct Line {
        ChordLanes<4> lengths;
        Batch jacobian;
    };

    /// The triangle of base + s w.
    [[nodiscard]] Line unwarpedLine(const LaneRecord& record, const LaneRays& rays) const {
        const Vec3f& last = record.flights->directions[2];
        const Batch across = rays.direction.dot(edges_.normal), inverse = 1.0f / across;
        const Batch along = -(rays.toOrigin.dot(edges_.normal) * inverse), alongPer = last.dot(edges_.normal) * inverse;
        const Lanes3 p = rays.toOrigin + rays.direction * along, q = rays.direction * alongPer - Lanes3(last);
        const Batch p1 = p.dot(edges_.first), p2 = p.dot(edges_.second), q1 = q.dot(edges_.first),
                    q2 = q.dot(edges_.second);
        return {{{p1, p2, -(p1 + p2), along}, {q1, q2, 1.0f - q1 - q2, alongPer}, {}, {}}, xsimd::abs(across)};
    }
    [[nodiscard]] static Line warpedLine(const LaneRecord& record, const LaneRays& rays) {
        const auto& w = record.flights->directions;
        const Lanes3 &c = rays.direction, a = Lanes3(w[0]) + c, b = Lanes3(w[1]) + c, d = Lanes3(w[2]) + c;
        const std::array<Lanes3, 3> rows{b.cross(d), d.cross(a), a.cross(b)};
        const Batch determinant = a.dot(rows[0]), inverse = 1.0f / determinant;
        Line line{{}, xsimd::abs(determinant)};
        for (size_t i = 0; i < 3; ++i) {
            line.lengths.offset[i] = rays.toOrigin.dot(rows[i]) * inverse;
            line.lengths.slope[i] = c.dot(rows[i]) * inverse;
        }
        const auto &p = line.lengths.offset, &q = line.lengths.slope;
        line.lengths.offset[3] = -(p[0] + p[1] + p[2]);
        line.lengths.slope[3] = 1.0f - q[0] - q[1] - q[2];
        return line;
    }
    /// Those whose path lengths the ray can meet.
    [[nodiscard]] static FrameRange frames(const LaneRecord& record, const LaneRays& rays, const Line& line,
                                           const LaneMask& seen) {
        if (record.times.frames == 1) return {0, 0};
        auto part = line.lengths;
        part.start = record.times.first - rays.lag;
        part.end = record.times.start(record.times.frames) - rays.lag;
        for (size_t i = 0; i < 3; ++i) part.keepPositive(part.offset[i], part.slope[i]);
        part.keep(part.offset[3], part.slope[3], rays.start, rays.end);
        const LaneMask met = seen && part.holds();
        return xsimd::any(met) ? framesOf(record.times, met, part.start + rays.lag, part.end + rays.lag)
                               : FrameRange{0, -1};
    }
    /// Near-singular systems lose their solution in rounding.
    [[nodiscard]] static LaneMask closes(const LaneRecord& record, const LaneRays& rays, const std::array<Batch, 3>& t,
                                         const Batch& along) {
        constexpr float Accuracy = 1e-4f;
        const auto& w = record.flights->directions;
        const Lanes3 miss =
            Lanes3(w[0]) * t[0] + Lanes3(w[1]) * t[1] + Lanes3(w[2]) * t[2] - rays.toOrigin - rays.direction * along;
        const Batch most = Accuracy * (t[0] + t[1] + t[2] + xsimd::abs(along));
        return miss.dot(miss) <= most * most;
    }
    /// (7), and the share of (16).
    [[nodiscard]] static Batch factor(const LaneRecord& record, const LaneRays& rays, const Batch& jacobian,
                                      const Batch& t1, const Batch& t2, const Batch& t3) {
        const Lanes3 last(record.flights->directions[2]);
        const Batch weight = record.towardsCamera(last, rays) / jacobian;
        return record.flights->shared ? weight * volumeWeight(record, rays, jacobian, t1, t2, t3) : weight;
    }

    ReciprocalBasis2 edges_; ///< of the unwarped triangle, per unit of path length
};

/// Inside each frame.
class VolumeChordLanes {
  public:
    explicit VolumeChordLanes(const SliceRecord& flights)
        : edges_(Vec3d(flights.directions[0]), Vec3d(flights.directions[1]), Vec3d(flights.directions[2])) {}
    /// emit(frame, reach)
    template <typename Emit>
    void intersect(const LaneRecord& record, const LaneRays& rays, Emit&& emit) const {
        if (!usable()) return;
        ChordLanes<3> chord{{}, {}, rays.start, rays.end};
        for (size_t i = 0; i < 3; ++i) {
            chord.offset[i] = rays.toOrigin.dot(edges_.rows[i]);
            chord.slope[i] = rays.direction.dot(edges_.rows[i]);
        }
        chord.keepFlights(record.reach);
        const LaneMask met = rays.seen && chord.holds();
        if (!xsimd::any(met)) return;
        const Batch p = chord.offsetSum(), q = chord.slopeSum() + record.warp();
        const Batch a = p + q * chord.start, b = p + q * chord.end;
        const Batch factor =
            record.towardsCamera(Lanes3(record.flights->directions[2]), rays) * (1.0f / edges_.determinant);
        const auto& w = record.flights->directions;
        const Batch slices = volumeJacobian(Lanes3(w[0]), Lanes3(w[1]), Lanes3(w[2]), rays.direction, record.warped);
        const FrameRange range = framesOf(record.times, met, xsimd::min(a, b) + rays.lag, xsimd::max(a, b) + rays.lag);
        for (int frame = range.first; frame <= range.last; ++frame) {
            if (record.times.factor(frame) == 0.0f) continue;
            ChordLanes<3> part = chord;
            part.keep(p, q, record.times.start(frame) - rays.lag, record.times.start(frame + 1) - rays.lag);
            const LaneMask here = met && part.holds();
            if (!xsimd::any(here)) continue;
            LaneHit hit = part.hit(record, here, factor, record.random(0, rays, frame));
            if (record.flights->shared) {
                const auto& [t1, t2, t3, none] = hit.lengths;
                hit.factor *= record.weighsPlaces() ? volumeWeightInGate(record, rays, hit)
                                                    : volumeWeight(record, rays, slices, t1, t2, t3);
            }
            emit(frame, hit);
        }
    }

  private:
    [[nodiscard]] bool usable() const { return edges_.determinant > LeastLaneDeterminant; }
    ReciprocalBasis3 edges_;
};

} // namespace tungsten::photon
