#include "tungsten/core/Transform.h"

namespace tungsten {

namespace {

/// Removes from `v` its part along the unit vectors given so far.
Vec3f residual(const Vec3f& v, const Vec3f& first) {
    return v - first * first.dot(v);
}

constexpr float DegenerateSquaredLength = 1e-5f;

/// Gram-Schmidt: `first` is kept, the others follow in order.
void orthogonalise(Vec3f& first, Vec3f& second, Vec3f& third) {
    first.normalize();
    second = residual(second.normalized(), first);
    if (second.length2() < DegenerateSquaredLength)
        second = std::abs(first.x) > std::abs(first.y) ? first.cross(Vec3f(0, 1, 0)) : first.cross(Vec3f(1, 0, 0));
    second.normalize();
    third = residual(residual(third.normalized(), first), second);
    if (third.length2() < DegenerateSquaredLength) third = first.cross(second);
    third.normalize();
}

/// Exact at multiples of a right angle, so that walls turned by them meet without gaps.
Vec2f cosineAndSine(float degrees) {
    constexpr float Quarter = 90.0f;
    if (std::remainder(degrees, Quarter) != 0.0f || !std::isfinite(degrees)) {
        const float angle = degrees * (Pi / 180.0f);
        return {std::cos(angle), std::sin(angle)};
    }
    constexpr float Cosines[] = {1.0f, 0.0f, -1.0f, 0.0f};
    const int turns = int(std::fmod(degrees / Quarter, 4.0f)) & 3;
    return {Cosines[turns], Cosines[(turns + 3) & 3]};
}

/// Rotation matrix columns applied to v: R = Ry(-ry) Rx(rx) Rz(rz).
Vec3f rotate(const Vec3f& v, const Vec3f& degrees) {
    const Vec2f x = cosineAndSine(degrees.x), y = cosineAndSine(-degrees.y), z = cosineAndSine(degrees.z);
    const Vec3f aboutZ(z.x * v.x - z.y * v.y, z.y * v.x + z.x * v.y, v.z);
    const Vec3f aboutX(aboutZ.x, x.x * aboutZ.y - x.y * aboutZ.z, x.y * aboutZ.y + x.x * aboutZ.z);
    return {y.x * aboutX.x + y.y * aboutX.z, aboutX.y, -y.y * aboutX.x + y.x * aboutX.z};
}

} // namespace

Frame Transform::rotation() const {
    return {x.normalized(), y.normalized(), z.normalized()};
}

Transform composeTransform(const TransformRecipe& recipe) {
    Vec3f x = recipe.xAxis, y = recipe.yAxis, z = recipe.zAxis;
    const bool hasX = recipe.hasX, hasY = recipe.hasY, hasZ = recipe.hasZ;
    if (!hasX || (hasX && hasY && hasZ)) {
        if (hasY && !hasX && !hasZ)
            orthogonalise(y, z, x);
        else
            orthogonalise(z, y, x);
    } else if (hasY) {
        orthogonalise(y, x, z);
    } else {
        hasZ ? orthogonalise(z, x, y) : orthogonalise(x, z, y);
    }
    if (x.cross(y).dot(z) < 0.0f) {
        if (!hasX)
            x = -x;
        else if (!hasY)
            y = -y;
        else
            z = -z;
    }
    Transform transform;
    transform.x = rotate(x * recipe.scale.x, recipe.rotationDegrees);
    transform.y = rotate(y * recipe.scale.y, recipe.rotationDegrees);
    transform.z = rotate(z * recipe.scale.z, recipe.rotationDegrees);
    transform.translation = recipe.position;
    return transform;
}

} // namespace tungsten
