#pragma once
// Tone curves for LDR output (docs/scene-format.md, section 3.2).

#include "tungsten/core/Types.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tungsten {

enum class ToneMap { Linear, Gamma, Reinhard, Filmic, Pbrt };

std::optional<ToneMap> toneMapByName(const std::string& name);
std::vector<std::string> toneMapNames();
/// Curve on the input clamped to >= 0.
Rgb applyToneMap(ToneMap toneMap, const Rgb& c);
/// floor(255 f), clamped to [0, 255].
std::array<uint8_t, 3> toLdr(const Rgb& toneMapped);

} // namespace tungsten
