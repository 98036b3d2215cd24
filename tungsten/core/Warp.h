#pragma once
// Warps of the unit square; every squareToX stands next to its density.

#include "tungsten/core/Types.h"

namespace tungsten::warp {

/// Uniform on the unit disk (concentric map, Shirley and Chiu 1997).
Vec2f squareToDisk(const Vec2f& u);
inline float squareToDiskPdf() {
    return InvPi;
}
/// Uniform direction on the sphere.
Vec3f squareToSphere(const Vec2f& u);
inline float squareToSpherePdf() {
    return 0.25f * InvPi;
}
/// Cosine-weighted direction on the hemisphere about +z; density per solid angle.
Vec3f squareToCosineHemisphere(const Vec2f& u);
inline float squareToCosineHemispherePdf(const Vec3f& v) {
    return std::max(v.z, 0.0f) * InvPi;
}
/// The same in the cone about +z with the given cosine (>= 0) of its half angle.
Vec3f squareToCosineCone(const Vec2f& u, float cosHalfAngle);
inline float squareToCosineConePdf(const Vec3f& v, float cosHalfAngle) {
    return v.z > 0.0f && v.z >= cosHalfAngle ? v.z * InvPi / (1.0f - sqr(cosHalfAngle)) : 0.0f;
}
/// Uniform direction in the cone about +z with the given cosine of its half angle; density per solid angle.
Vec3f squareToCone(const Vec2f& u, float cosHalfAngle);
float squareToConePdf(float cosHalfAngle);
/// Uniform barycentric coordinates (b1, b2) on a triangle.
Vec2f squareToTriangle(const Vec2f& u);

} // namespace tungsten::warp
