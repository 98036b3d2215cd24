#pragma once
// Slices of volumes and balls for a register of rays at a time: VolumeSlice.h and BallSlice.h in floats.

#include "photon/raster/Registers.h"

namespace tungsten::photon {

using LaneMask = Batch::batch_bool_type;

/// A register of vectors.
struct Lanes3 {
    Batch x, y, z;

    Lanes3(const Batch& x_, const Batch& y_, const Batch& z_) : x(x_), y(y_), z(z_) {}
    explicit Lanes3(const Vec3f& v) : x(v.x), y(v.y), z(v.z) {}
    [[nodiscard]] Batch dot(const Lanes3& o) const { return x * o.x + y * o.y + z * o.z; }
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

/// Rays, relative to a record's base, and the path lengths left there.
struct LaneRays {
    Lanes3 toOrigin, direction; ///< toOrigin: from the base
    Batch residual;
};

/// Rays that meet a slice.
struct LaneSlice {
    LaneMask met;
    Batch t1, t2, t3, alongRay, jacobian;
};

/// Below it a float determinant is rounding (LeastDeterminant).
inline constexpr float LeastLaneDeterminant = 1e-4f;

/// A volume's three directions, and what they have in common for every ray.
class VolumeLanes {
  public:
    explicit VolumeLanes(const std::array<Vec3f, 3>& w) : w_(w) {
        const Vec3f a = w[0] - w[2], b = w[1] - w[2];
        normal_ = a.cross(b);
        const float square = normal_.length2();
        // t1 = p . first, t2 = p . second for p = t1 a + t2 b.
        if (square > 0.0f) {
            first_ = b.cross(normal_) / square;
            second_ = normal_.cross(a) / square;
        }
    }
    /// |det|, (8)
    [[nodiscard]] Batch jacobian(const Lanes3& ray, bool warped) const {
        return xsimd::abs(warped ? jacobianWarped(ray) : Lanes3(normal_).dot(ray));
    }
    [[nodiscard]] LaneSlice meet(const LaneRays& rays, bool warped) const {
        return warped ? meetWarped(rays) : meetUnwarped(rays);
    }

  private:
    [[nodiscard]] Batch jacobianWarped(const Lanes3& c) const {
        return (Lanes3(w_[0]) + c).dot((Lanes3(w_[1]) + c).cross(Lanes3(w_[2]) + c));
    }
    /// The triangle of base + residual w.
    [[nodiscard]] LaneSlice meetUnwarped(const LaneRays& rays) const {
        const Lanes3 r = rays.toOrigin - Lanes3(w_[2]) * rays.residual, normal(normal_);
        const Batch across = normal.dot(rays.direction), t = -(normal.dot(r) / across);
        const Lanes3 p = r + rays.direction * t;
        LaneSlice s{rays.residual > 0.0f, p.dot(Lanes3(first_)), p.dot(Lanes3(second_)), Batch(0.0f), t,
                    xsimd::abs(across)};
        s.t3 = rays.residual - s.t1 - s.t2;
        s.met = s.met && s.jacobian > LeastLaneDeterminant && s.t1 >= 0.0f && s.t2 >= 0.0f && s.t3 >= 0.0f;
        return s;
    }
    [[nodiscard]] LaneSlice meetWarped(const LaneRays& rays) const {
        const Lanes3 &c = rays.direction, a = Lanes3(w_[0]) + c, b = Lanes3(w_[1]) + c, d = Lanes3(w_[2]) + c;
        const Lanes3 r = rays.toOrigin + c * rays.residual, first = b.cross(d);
        const Batch determinant = a.dot(first), inverse = 1.0f / determinant;
        LaneSlice s{
            rays.residual > 0.0f, r.dot(first) * inverse, r.dot(d.cross(a)) * inverse, r.dot(a.cross(b)) * inverse,
            Batch(0.0f),          xsimd::abs(determinant)};
        s.alongRay = rays.residual - s.t1 - s.t2 - s.t3;
        const Lanes3 miss =
            Lanes3(w_[0]) * s.t1 + Lanes3(w_[1]) * s.t2 + Lanes3(w_[2]) * s.t3 - rays.toOrigin - c * s.alongRay;
        constexpr float Accuracy = 1e-4f;
        s.met = s.met && s.jacobian > LeastLaneDeterminant && s.t1 >= 0.0f && s.t2 >= 0.0f && s.t3 >= 0.0f &&
                miss.dot(miss) <= Accuracy * Accuracy * rays.residual * rays.residual;
        return s;
    }

    std::array<Vec3f, 3> w_;
    Vec3f normal_, first_{0.0f}, second_{0.0f};
};

/// A ball's reaches on a register of rays: `near` and `far` for a sphere, near alone for an ellipsoid.
struct BallLanes {
    Batch length, nearRay, farRay, jacobian;
    LaneMask met;

    BallLanes(const LaneRays& rays, bool warped) {
        const Lanes3 e = -rays.toOrigin;
        const Batch foot = e.dot(rays.direction);
        const Batch& s = rays.residual;
        if (warped) {
            const Batch distance = xsimd::sqrt(e.dot(e));
            const Lanes3 d = rays.direction * s - e;
            nearRay = farRay = (s - distance) * (s + distance) / (2.0f * (s - foot));
            length = s - nearRay;
            jacobian = 0.5f * d.dot(d);
            met = s > distance && jacobian > 0.0f;
        } else {
            const Lanes3 off = e.cross(rays.direction);
            const Batch h = xsimd::sqrt(off.dot(off));
            const Batch half = xsimd::sqrt(xsimd::max((s - h) * (s + h), Batch(0.0f)));
            length = s;
            nearRay = foot - half;
            farRay = foot + half;
            jacobian = s * half;
            met = s > h && jacobian > 0.0f;
        }
    }
};

/// A point of a narrow gate for every ray of a register, as BallGate draws it; the piece of the ray that counts is left
/// to the caller to test.
struct BallGateLanes {
    Batch length, alongRay;
    Batch density; ///< angles over distance from the ray
    LaneMask met;

    /// `rays.residual`: at the gate's end; `width`: of the gate, a length; u in [0, 1).
    BallGateLanes(const LaneRays& rays, float width, const Batch& u, bool warped) {
        const Lanes3 e = -rays.toOrigin, off = e.cross(rays.direction);
        const Batch foot = e.dot(rays.direction), h = xsimd::sqrt(off.dot(off));
        const Batch late = rays.residual, soon = late - width;
        Batch from, to, drawn = u;
        if (warped) {
            const Batch distance = xsimd::sqrt(e.dot(e));
            const auto turn = [&](const Batch& s) {
                return xsimd::select(s > distance, (s - distance) * (s + distance) / (2.0f * (s - foot)), Batch(0.0f));
            };
            from = turn(soon) - foot;
            to = turn(late) - foot;
        } else {
            // Both halves of the chord alike.
            const auto half = [&](const Batch& s) { return xsimd::sqrt(xsimd::max((s - h) * (s + h), Batch(0.0f))); };
            from = half(xsimd::max(soon, Batch(0.0f)));
            to = half(late);
            drawn = xsimd::abs(2.0f * u - 1.0f); // from the chord's near end to its far one
        }
        const Batch angle = xsimd::atan2(h * (to - from), h * h + from * to), slope = xsimd::tan(drawn * angle);
        const Batch beside = h * (from + h * slope) / (h - from * slope);
        met = late > 0.0f && to > from && h > 0.0f;
        if (!warped) met = met && late > h;
        length = xsimd::sqrt(h * h + beside * beside);
        alongRay = foot + (warped ? beside : xsimd::select(u < 0.5f, -beside, beside));
        density = (warped ? angle : 2.0f * angle) / h;
    }
};

} // namespace tungsten::photon
