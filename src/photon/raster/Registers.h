#pragma once
// Registers of floats.

#include "darts/Lanes.h"

#include "tungsten/core/Types.h"

#include <array>

namespace tungsten::photon {

using Batch = xsimd::batch<float>;
inline constexpr int Lanes = int(Batch::size);
static_assert(Lanes <= 16);
alignas(64) inline constexpr float LaneNumbers[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// Calls visit(k) for every lane k of the mask.
template <typename Visit>
void eachLane(const Batch::batch_bool_type& mask, const Visit& visit) {
    if (!xsimd::any(mask)) return;
    alignas(64) std::array<float, size_t(Lanes)> chosen;
    xsimd::select(mask, Batch(1.0f), Batch(0.0f)).store_aligned(chosen.data());
    for (size_t k = 0; k < size_t(Lanes); ++k)
        if (chosen[k] > 0.0f) visit(k);
}

/// Henyey-Greenstein from the direction `before` to the way back along rays (dx, dy, dz), about its peak as
/// PhaseFunction has it. The formula stands in three places on purpose: tungsten/medium for one pair of directions,
/// here for a register of rays, where a call for each would cost most of a splat, and in src/darts, which knows no
/// renderer. Tests hold them to the same values.
inline Batch henyeyGreenstein(float g, const Vec3f& before, const Batch& dx, const Batch& dy, const Batch& dz) {
    if (g == 0.0f) return Batch(0.25f * InvPi);
    const float strength = std::abs(g);
    const Vec3f peak = g < 0.0f ? -before : before;
    const Batch x = dx + peak.x, y = dy + peak.y, z = dz + peak.z;
    const Batch d = (1.0f - strength) * (1.0f - strength) + strength * (x * x + y * y + z * z);
    return (1.0f - strength) * (1.0f + strength) * 0.25f * InvPi / (d * xsimd::sqrt(d));
}

} // namespace tungsten::photon
