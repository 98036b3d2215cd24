#pragma once
// The way out of a body through a plane boundary that refracts (docs/method.md, section 10.5).

#include "tungsten/core/Types.h"

#include <optional>

namespace tungsten::path {

/// From a point at `depth` behind a plane to one at `height` before it. Angles are to the normal.
struct RefractedPath {
    float depth, height;
    float cosInside, cosOutside;

    /// Lengths of the two straight parts.
    [[nodiscard]] float inside() const { return depth / cosInside; }
    [[nodiscard]] float outside() const { return height / cosOutside; }
    /// Area at its end, on a plane parallel to the boundary, over the solid angle at its start. `index`: inside over
    /// outside.
    [[nodiscard]] float areaPerSolidAngle(float index) const;
};

/// The one way whose ends are `lateral` apart along the plane; none if `depth` or `height` is not above 0, or where
/// rounding leaves no angle. `index`: refractive index inside over outside.
std::optional<RefractedPath> refractedPath(float depth, float height, float lateral, float index);

/// Beyond the plane of a unit normal, outward; `direction` leads out. None under total internal reflection.
std::optional<Vec3f> refractedOut(const Vec3f& direction, const Vec3f& normal, float index);

} // namespace tungsten::path
