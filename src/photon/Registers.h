#pragma once
// Registers of floats.

#include <xsimd/xsimd.hpp>

namespace tungsten::photon {

using Batch = xsimd::batch<float>;
inline constexpr int Lanes = int(Batch::size);
static_assert(Lanes <= 16);
alignas(64) inline constexpr float LaneNumbers[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

} // namespace tungsten::photon
