#pragma once
// The value types every room shares: vectors and colours (Imath), rays, frames.
// Geometry and radiance are float; path lengths and times are double.

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tungsten {

using Vec2f = Imath::V2f;
using Vec2i = Imath::V2i;
using Vec3f = Imath::V3f;
using Vec3d = Imath::V3d;
/// Linear RGB radiance, power, albedo or coefficient.
using Rgb = Imath::C3f;

inline constexpr float Pi = 3.14159265358979323846f;
inline constexpr float InvPi = 0.31830988618379067154f;
inline constexpr float Infinity = std::numeric_limits<float>::infinity();

inline float sqr(float x) {
    return x * x;
}
inline float maxComponent(const Rgb& c) {
    return std::max(c.x, std::max(c.y, c.z));
}
inline float meanComponent(const Rgb& c) {
    return (c.x + c.y + c.z) * (1.0f / 3.0f);
}
inline bool isBlack(const Rgb& c) {
    return c.x == 0.0f && c.y == 0.0f && c.z == 0.0f;
}
inline bool isFinite(const Rgb& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}
/// Component-wise e^{-c}.
inline Rgb expNegative(const Rgb& c) {
    return {std::exp(-c.x), std::exp(-c.y), std::exp(-c.z)};
}

/// A face of a scene's geometry; none by default.
struct FaceIndex {
    static constexpr uint32_t None = ~0u;

    uint32_t shape = None;
    uint32_t face = 0; ///< triangle of a mesh; else 0

    [[nodiscard]] bool isSet() const { return shape != None; }
};

/// A ray in world space; `direction` has unit length, so distances along it are lengths.
struct Ray {
    Vec3f origin;
    Vec3f direction;
    float tMin = 0.0f;
    float tMax = Infinity;
    FaceIndex leaves{}; ///< the face it starts on, if any: others at the same place may be next

    [[nodiscard]] Vec3f at(float t) const { return origin + direction * t; }
};

/// Derivatives of a surface's position by the two coordinates of its textures.
struct Tangents {
    Vec3f u, v;
};

/// Right-handed orthonormal frame (s, t, n); local z is n.
struct Frame {
    Vec3f s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

    Frame() = default;
    Frame(const Vec3f& s_, const Vec3f& t_, const Vec3f& n_) : s(s_), t(t_), n(n_) {}
    /// Any frame about the unit vector `normal` (Duff et al. 2017, branchless construction).
    explicit Frame(const Vec3f& normal) : n(normal) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        s = Vec3f(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
        t = Vec3f(b, sign + n.y * n.y * a, -n.y);
    }
    /// Frame about `normal` whose s axis is `tangent` projected into the plane.
    Frame(const Vec3f& normal, const Vec3f& tangent) : Frame(normal) {
        const Vec3f projected = tangent - normal * normal.dot(tangent);
        const float length = projected.length();
        if (length > 1e-12f) {
            s = projected / length;
            t = n.cross(s);
        }
    }

    [[nodiscard]] Vec3f toLocal(const Vec3f& w) const { return {s.dot(w), t.dot(w), n.dot(w)}; }
    [[nodiscard]] Vec3f toWorld(const Vec3f& l) const { return s * l.x + t * l.y + n * l.z; }
};

} // namespace tungsten
