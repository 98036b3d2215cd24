#pragma once
// A register of camera rays and what a sliced primitive brings to it: what the primitives' kernels in floats share.

#include "photon/primitives/sliced/SliceRecord.h"
#include "photon/raster/Registers.h"

#include <span>

namespace tungsten::photon {

using LaneMask = Batch::batch_bool_type;

/// A register of vectors.
struct Lanes3 {
    Batch x, y, z;

    Lanes3(const Batch& x_, const Batch& y_, const Batch& z_) : x(x_), y(y_), z(z_) {}
    explicit Lanes3(const Vec3f& v) : x(v.x), y(v.y), z(v.z) {}
    [[nodiscard]] Batch dot(const Lanes3& o) const { return x * o.x + y * o.y + z * o.z; }
    [[nodiscard]] Batch dot(const Vec3f& o) const { return x * o.x + y * o.y + z * o.z; }
    [[nodiscard]] Lanes3 cross(const Lanes3& o) const {
        return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
    }
    [[nodiscard]] Lanes3 operator+(const Lanes3& o) const { return {x + o.x, y + o.y, z + o.z}; }
    [[nodiscard]] Lanes3 operator-(const Lanes3& o) const { return {x - o.x, y - o.y, z - o.z}; }
    [[nodiscard]] Lanes3 operator*(const Batch& f) const { return {x * f, y * f, z * f}; }
    [[nodiscard]] Lanes3 operator-() const { return {-x, -y, -z}; }
};

/// Henyey-Greenstein, about its peak as PhaseFunction has it.
inline Batch henyeyGreenstein(float g, const Lanes3& before, const Lanes3& after) {
    if (g == 0.0f) return Batch(0.25f * InvPi);
    const float strength = std::abs(g);
    const Lanes3 off = g < 0.0f ? after + before : after - before;
    const Batch d = (1.0f - strength) * (1.0f - strength) + strength * off.dot(off);
    return (1.0f - strength) * (1.0f + strength) * 0.25f * InvPi / (d * xsimd::sqrt(d));
}

/// For p = x a + y b: x = p . first, y = p . second. Found in double, once for each record: cross products of nearly
/// parallel directions keep few digits of a float.
struct ReciprocalBasis2 {
    Vec3f normal, first{0.0f}, second{0.0f};

    ReciprocalBasis2(const Vec3f& a, const Vec3f& b) {
        const Vec3d u(a), v(b), across = u.cross(v);
        normal = Vec3f(across);
        const double square = across.length2();
        if (!(square > 0.0)) return;
        first = Vec3f(v.cross(across) / square);
        second = Vec3f(across.cross(u) / square);
    }
};

/// For p = x a + y b + z c: x = p . rows[0] and so on. In double, as ReciprocalBasis2.
struct ReciprocalBasis3 {
    std::array<Vec3f, 3> rows{};
    float determinant; ///< |a b c|

    ReciprocalBasis3(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        const std::array<Vec3d, 3> across{b.cross(c), c.cross(a), a.cross(b)};
        const double whole = a.dot(across[0]);
        determinant = float(std::abs(whole));
        if (!(determinant > 0.0f)) return;
        for (size_t i = 0; i < 3; ++i) rows[i] = Vec3f(across[i] / whole);
    }
};

/// Below it a float determinant is rounding (LeastDeterminant).
inline constexpr float LeastLaneDeterminant = 1e-4f;

/// A gate as path lengths left at a record's base, less one that its rays have in common (LaneRays::lag).
struct LaneTimes {
    float first = 0.0f, width = 0.0f; ///< start and length of frame 0; width 0: at one length
    int frames = 1;
    std::span<const float> shares{}; ///< factors on the power, by frame (FrameRoulette)

    [[nodiscard]] float factor(int frame) const { return shares.empty() ? 1.0f : shares[size_t(frame)]; }
    [[nodiscard]] float start(int frame) const { return first + float(frame) * width; }
};

/// A register of rays, relative to a record's base.
struct LaneRays {
    Lanes3 toOrigin, direction; ///< toOrigin: from the base to any point of the ray, from which lengths along it count
    Batch start, end;           ///< the piece that is looked at
    LaneMask seen;              ///< rays that have it
    Batch rotation;             ///< of random numbers
    /// What is left of a time at such a point is that of LaneTimes less this: how far the point lies along the ray,
    /// less the length that LaneTimes lack. 0 where the ray's length does not count.
    Batch lag = Batch(0.0f);

    /// These rays, started at their points next to the base when they come from far away: what is small beside the
    /// distance of the camera would be lost in it. `common`: that of the base, which LaneTimes lack.
    [[nodiscard]] LaneRays fromFeet(float common, bool warped) const {
        const Batch foot = -toOrigin.dot(direction);
        LaneRays rays{toOrigin + direction * foot, direction, start - foot, end - foot, seen, rotation};
        if (warped) rays.lag = foot - common;
        return rays;
    }
    /// Distance of the base from the ray's line.
    [[nodiscard]] Batch distance() const {
        const Lanes3 off = toOrigin.cross(direction);
        return xsimd::sqrt(off.dot(off));
    }
    /// Least way from the base over the ray's piece back along it.
    [[nodiscard]] Batch leastWay() const {
        const Batch h = distance(), foot = -toOrigin.dot(direction), ahead = start - foot;
        const Batch way = xsimd::sqrt(h * h + ahead * ahead);
        return foot + xsimd::select(ahead < 0.0f, h * h / (way - ahead), way + ahead);
    }
    /// The least length to the ray, as LaneTimes count it.
    [[nodiscard]] Batch soonest(bool warped) const { return warped ? leastWay() + lag : distance(); }
};

/// A record for registers of rays, in a medium with Henyey-Greenstein scattering.
struct LaneRecord {
    const SliceRecord* flights;
    LaneTimes times;
    Rgb sigmaT;
    bool grey;
    bool warped;  ///< the ray's length counts in times
    bool far;     ///< the camera is, beside what is left of times: rays are looked at from their feet
    float common; ///< what `times` lack: how far the camera is from the base, about, if that is far
    float g;
    float reach;      ///< of the first flight, if something can be in the way
    bool drawsPoints; ///< on chords: something can be in the way, or balls share the path
    float phasePdf;   ///< a volume: of its third direction
    float pdfs;       ///< a ball: of the two flights that led to it
    /// How light leaves a ball's centre: by the phase function, alike everywhere, or by the cosine from the light's
    /// normal, where that is at least `leastCosine`.
    enum class Leaving { Phase, Evenly, Cosine } leaving;
    float leastCosine;

    [[nodiscard]] float warp() const { return warped ? 1.0f : 0.0f; }
    /// Rays from where they begin, with the lengths that `times` go with.
    [[nodiscard]] LaneRays placed(const LaneRays& asCast) const {
        return far ? asCast.fromFeet(common, warped) : asCast;
    }
    [[nodiscard]] bool weighsPlaces() const { return times.frames == 1 && times.width > 0.0f; }
    /// In [0, 1): RaySliceQuery::random.
    [[nodiscard]] Batch random(size_t which, const LaneRays& rays, int frame) const {
        const Batch u = rays.rotation + float(flights->randomNumber(which) + frameRotation(frame));
        return xsimd::min(u - xsimd::floor(u), Batch(0x1.fffffep-1f));
    }
    /// Path length left at the base: a random one of the frame's, or the only one.
    [[nodiscard]] Batch residual(const LaneRays& rays, int frame) const {
        if (times.width == 0.0f) return times.first - rays.lag;
        return times.start(frame) - rays.lag + random(0, rays, frame) * times.width;
    }
    /// Phase function from the last flight to the camera.
    [[nodiscard]] Batch towardsCamera(const Lanes3& last, const LaneRays& rays) const {
        return henyeyGreenstein(g, last, -rays.direction);
    }
    /// Probability density of a free flight: the mean of the channels'.
    [[nodiscard]] Batch flightPdf(const Batch& t) const {
        if (grey) return sigmaT.x * xsimd::exp(-sigmaT.x * t);
        Batch sum(0.0f);
        for (int k = 0; k < 3; ++k) sum += sigmaT[k] * xsimd::exp(-sigmaT[k] * t);
        return sum * (1.0f / 3.0f);
    }
};

/// Mean of e^{-x} from 0 to z >= 0.
inline Batch meanOfFall(const Batch& z) {
    return xsimd::select(z < 0.02f, 1.0f - z * (0.5f - z * (1.0f / 6.0f)),
                         (1.0f - xsimd::exp(-z)) / xsimd::max(z, Batch(0.02f)));
}

/// What a register of rays meets of a record: a point of each ray, or a chord that is integrated over.
struct LaneHit {
    LaneMask met;
    Batch alongRay;                 ///< the point, or the chord's end where light is brightest
    Batch length;                   ///< of the flights and the ray up to there: they let e^{-sigma_t length} through
    Batch factor;                   ///< all the rest but power and collapsed collisions
    std::array<Batch, 4> lengths{}; ///< of the flights, as shadow rays need them
    bool integrated = false;
    Batch chord = Batch(0.0f), fall = Batch(0.0f); ///< if integrated: its length, and how fast `length` grows along it

    /// Without the part of the ray before `start`.
    [[nodiscard]] Batch weight(float sigmaT, const Batch& start) const {
        const Batch w = factor * xsimd::exp(xsimd::select(met, -sigmaT * (length - start), Batch(0.0f)));
        return integrated ? w * chord * meanOfFall(sigmaT * fall * chord) : w;
    }
};

/// Consecutive frames.
struct FrameRange {
    int first, last;
};

/// Those in which something that is left between `least` and `most` of any of the lanes `met` falls.
inline FrameRange framesOf(const LaneTimes& times, const LaneMask& met, const Batch& least, const Batch& most) {
    if (times.frames == 1) return {0, 0};
    const float soonest = -darts::lanes::most(xsimd::select(met, -least, Batch(-Infinity)));
    const float latest = darts::lanes::most(xsimd::select(met, most, Batch(-Infinity)));
    const auto frame = [&](float length) {
        return int(std::clamp((length - times.first) / times.width, -1.0f, float(times.frames)));
    };
    if (!(latest >= times.first)) return {0, -1};
    return {std::max(frame(soonest), 0), std::min(frame(latest), times.frames - 1)};
}

/// Chord for a register of rays: where all lengths, linear in one unknown, are flights'.
template <size_t K>
struct ChordLanes {
    std::array<Batch, K> offset, slope; ///< lengths t_i = offset + slope t
    Batch start, end;                   ///< of the unknown t; empty unless start < end

    [[nodiscard]] LaneMask holds() const { return start < end; }
    [[nodiscard]] Batch length(size_t i, const Batch& t) const { return offset[i] + slope[i] * t; }
    [[nodiscard]] Batch offsetSum() const {
        Batch sum = offset[0];
        for (size_t i = 1; i < K; ++i) sum += offset[i];
        return sum;
    }
    [[nodiscard]] Batch slopeSum() const {
        Batch sum = slope[0];
        for (size_t i = 1; i < K; ++i) sum += slope[i];
        return sum;
    }
    /// Keeps the part where p + q t >= 0.
    void keepPositive(const Batch& p, const Batch& q) {
        const Batch root = -(p / q);
        const LaneMask rises = q >= 0.0f;
        start = xsimd::select(rises, xsimd::max(start, root), start);
        end = xsimd::select(rises, end, xsimd::min(end, root));
    }
    void keep(const Batch& p, const Batch& q, const Batch& least, const Batch& most) {
        keepPositive(p - least, q);
        keepPositive(most - p, -q);
    }
    /// Keeps what lies inside every flight, the first of which ends at `reach`.
    void keepFlights(float reach) {
        for (size_t i = 0; i < K; ++i) keepPositive(offset[i], slope[i]);
        if (reach < Infinity) keepPositive(reach - offset[0], -slope[0]);
    }
    /// With t the distance along the ray: (10) and (15) for long flights, or at a point drawn by their integrand.
    /// `factor`: without lengths.
    [[nodiscard]] LaneHit hit(const LaneRecord& record, const LaneMask& met, const Batch& factor,
                              const Batch& u) const {
        const Batch first = xsimd::select(met, start, Batch(0.0f)), last = xsimd::select(met, end, Batch(0.0f));
        const Batch rise = slopeSum() + 1.0f, fall = xsimd::abs(rise), chord = last - first;
        const LaneMask falls = rise >= 0.0f;
        Batch t = xsimd::select(falls, first, last);
        LaneHit hit{met, t, offsetSum() + rise * t, factor};
        if (!record.drawsPoints) {
            hit.integrated = true;
            hit.chord = chord;
            hit.fall = fall;
            return hit;
        }
        const Batch sigma(meanComponent(record.sigmaT)), z = sigma * fall * chord;
        const Batch v = xsimd::select(falls, u, 1.0f - u); // from the bright end, as drawn from the start
        // u = 0 stands for what is below 2^-24: v is 1 there, and all of a long chord's light would be left of nothing.
        const Batch left = xsimd::max(1.0f - v * (1.0f - xsimd::exp(-z)), Batch(0x1p-25f));
        const Batch exact = -xsimd::log(left) / xsimd::max(sigma * fall, Batch(1e-30f));
        const Batch along = xsimd::min(xsimd::select(z < 1e-3f, v * chord, exact), chord);
        t = xsimd::select(falls, first + along, last - along);
        hit.alongRay = t;
        hit.length = offsetSum() + rise * t;
        hit.factor = factor * chord * meanOfFall(z) / left;
        for (size_t i = 0; i < K; ++i) hit.lengths[i] = xsimd::max(length(i, t), Batch(0.0f));
        return hit;
    }
};

} // namespace tungsten::photon
