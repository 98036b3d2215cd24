#pragma once
// Three floats, and directions about an axis in forms that keep small angles.

#include <algorithm>
#include <cmath>

namespace darts {

inline constexpr float Pi = 3.14159265358979323846f;

/// A position, a direction or three colour channels.
struct Vec3 {
    float x = 0, y = 0, z = 0;

    friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
    friend Vec3 operator*(const Vec3& a, float s) { return {a.x * s, a.y * s, a.z * s}; }
    friend Vec3 operator*(float s, const Vec3& a) { return a * s; }
    friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
    Vec3& operator*=(const Vec3& b) { return *this = *this * b; }
};

/// From a host's own vector with members x, y, z.
template <typename Vector>
Vec3 vec3(const Vector& v) {
    return {v.x, v.y, v.z};
}
/// To a host's own vector, made of three floats.
template <typename Vector>
Vector to(const Vec3& v) {
    return {v.x, v.y, v.z};
}

inline float dot(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float squaredLength(const Vec3& a) {
    return dot(a, a);
}
inline float length(const Vec3& a) {
    return std::sqrt(dot(a, a));
}
inline float mean(const Vec3& a) {
    return (a.x + a.y + a.z) * (1.0f / 3.0f);
}
inline float largest(const Vec3& a) {
    return std::max({a.x, a.y, a.z});
}
inline float smallest(const Vec3& a) {
    return std::min({a.x, a.y, a.z});
}

/// h = 1 - cos of the angle between unit vectors, exact to rounding of their difference; never 1 - dot.
inline float oneMinusCosine(const Vec3& a, const Vec3& b) {
    return std::min(0.5f * squaredLength(a - b), 2.0f);
}

/// Unit vector with 1 - cos(theta) = h in [0, 2] from the unit vector `axis`, at azimuth 2 pi u (orthonormal basis:
/// Duff et al. 2017).
inline Vec3 directionAbout(const Vec3& axis, float h, float u) {
    const float sine = std::sqrt(std::max(h * (2.0f - h), 0.0f)), phi = 2.0f * Pi * u;
    const float sign = std::copysign(1.0f, axis.z), a = -1.0f / (sign + axis.z), b = axis.x * axis.y * a;
    const Vec3 s{1.0f + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
    const Vec3 t{b, sign + axis.y * axis.y * a, -axis.y};
    return s * (sine * std::cos(phi)) + t * (sine * std::sin(phi)) + axis * (1.0f - h);
}

} // namespace darts
