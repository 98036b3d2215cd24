#pragma once
// Affine transforms of the scene format: column vectors, p' = M p.

#include "tungsten/core/Types.h"

namespace tungsten {

/// Affine map with columns x, y, z (images of the unit axes) and translation.
struct Transform {
    Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, translation{0, 0, 0};

    [[nodiscard]] Vec3f point(const Vec3f& p) const { return x * p.x + y * p.y + z * p.z + translation; }
    [[nodiscard]] Vec3f vector(const Vec3f& v) const { return x * v.x + y * v.y + z * v.z; }
    /// The vector that vector() maps to `v`; the determinant must not be 0.
    [[nodiscard]] Vec3f inverseVector(const Vec3f& v) const {
        return Vec3f(y.cross(z).dot(v), z.cross(x).dot(v), x.cross(y).dot(v)) / determinant();
    }
    /// Column lengths: the scale factors of a transform without shear.
    [[nodiscard]] Vec3f scale() const { return {x.length(), y.length(), z.length()}; }
    /// Columns normalised: the rotation part (may mirror).
    [[nodiscard]] Frame rotation() const;
    [[nodiscard]] float determinant() const { return x.cross(y).dot(z); }
};

/// The object form of a transform (docs/scene-format.md, section 2): basis by priority of the explicitly given axes,
/// then scale, then rotation about y (negated), x, z, then translation.
struct TransformRecipe {
    Vec3f position{0, 0, 0};
    Vec3f xAxis{1, 0, 0}, yAxis{0, 1, 0}, zAxis{0, 0, 1};
    bool hasX = false, hasY = false, hasZ = false;
    Vec3f scale{1, 1, 1};
    Vec3f rotationDegrees{0, 0, 0};
};

Transform composeTransform(const TransformRecipe& recipe);

} // namespace tungsten
