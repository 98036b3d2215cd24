#pragma once
// The frame that a BSDF with a bump map is evaluated in.

#include "tungsten/bsdf/Bsdf.h"

namespace tungsten {

/// About the normal of the tangents that the BSDF's bump map displaces (docs/scene-format.md, section 5).
Frame bumpedFrame(const Bsdf& bsdf, const Vec3f& ns, const Tangents& tangents, const Vec2f& uv);

} // namespace tungsten
