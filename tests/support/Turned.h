#pragma once

#include "tungsten/core/Transform.h"

namespace tungsten::test {

/// Scaled, then turned by Euler angles, then moved.
inline Transform turned(const Vec3f& degrees, const Vec3f& scale, const Vec3f& position = Vec3f(0.0f)) {
    TransformRecipe recipe;
    recipe.rotationDegrees = degrees;
    recipe.scale = scale;
    recipe.position = position;
    return composeTransform(recipe);
}

} // namespace tungsten::test
