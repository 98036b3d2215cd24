#pragma once
// Surfaces of which one number says all that they scatter.

#include "tungsten/bsdf/Bsdf.h"

namespace tungsten {

/// Whether f, straight passage aside, is one value for all directions on the side that light comes from, and 0 on the
/// other: then it is known before a direction is. Models that are even at some parameters alone count as uneven.
bool isLambertian(const Bsdf& bsdf);

} // namespace tungsten
