#pragma once

#include "tungsten/core/Transform.h"

namespace tungsten::test {

/// Scaled, then turned by Euler angles, then moved.
inline Transform turned(const Vec3f& degrees, const Vec3f& scale, const Vec3f& position) {
    TransformRecipe recipe;
    recipe.rotationDegrees = degrees;
    recipe.scale = scale;
    recipe.position = position;
    return composeTransform(recipe);
}

} // namespace tungsten::test
