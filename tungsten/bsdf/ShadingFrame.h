#pragma once
// The frame a BSDF is evaluated in, bump map included.

#include "tungsten/bsdf/Bsdf.h"

namespace tungsten {

/// About the shading normal; with a bump map, about the normal of the displaced tangents (docs/scene-format.md, section
/// 5).
Frame shadingFrame(const Bsdf& bsdf, const Vec3f& ns, const Vec3f& dpdu, const Vec3f& dpdv, const Vec2f& uv);

} // namespace tungsten
