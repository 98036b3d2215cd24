#include "tungsten/core/Warp.h"

namespace tungsten::warp {

Vec2f squareToDisk(const Vec2f& u) {
    const float a = 2.0f * u.x - 1.0f;
    const float b = 2.0f * u.y - 1.0f;
    if (a == 0.0f && b == 0.0f) return {0.0f, 0.0f};
    const bool wide = std::abs(a) > std::abs(b);
    const float radius = wide ? a : b;
    const float angle = wide ? 0.25f * Pi * (b / a) : 0.5f * Pi - 0.25f * Pi * (a / b);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

Vec3f squareToSphere(const Vec2f& u) {
    const float z = 1.0f - 2.0f * u.x;
    // sin² = (1 - z)(1 + z) in terms of u, free of cancellation.
    const float radius = 2.0f * std::sqrt(u.x * (1.0f - u.x));
    const float phi = 2.0f * Pi * u.y;
    return {radius * std::cos(phi), radius * std::sin(phi), z};
}

Vec3f squareToCosineHemisphere(const Vec2f& u) {
    const Vec2f p = squareToDisk(u);
    // From the distance to the square's border, free of cancellation: directions are never in the surface, where a ray
    // slips through what touches it. Of random numbers of 24 bits 0 is an interval, whose middle stands for it.
    constexpr float Least = 0x1p-25f;
    const float fromRim = 2.0f * std::max(std::min({u.x, 1.0f - u.x, u.y, 1.0f - u.y}), Least);
    return {p.x, p.y, std::sqrt(fromRim * (2.0f - fromRim))};
}

Vec3f squareToCosineCone(const Vec2f& u, float cosHalfAngle) {
    const Vec2f p = squareToDisk(u) * std::sqrt((1.0f - cosHalfAngle) * (1.0f + cosHalfAngle));
    return {p.x, p.y, std::sqrt(std::max(1.0f - p.x * p.x - p.y * p.y, 0.0f))};
}

Vec3f squareToCone(const Vec2f& u, float cosHalfAngle) {
    const float oneMinusCos = u.x * (1.0f - cosHalfAngle);
    const float radius = std::sqrt(oneMinusCos * (2.0f - oneMinusCos));
    const float phi = 2.0f * Pi * u.y;
    return {radius * std::cos(phi), radius * std::sin(phi), 1.0f - oneMinusCos};
}

float squareToConePdf(float cosHalfAngle) {
    return 1.0f / (2.0f * Pi * (1.0f - cosHalfAngle));
}

Vec2f squareToTriangle(const Vec2f& u) {
    const float root = std::sqrt(u.x);
    return {root * (1.0f - u.y), root * u.y};
}

} // namespace tungsten::warp
