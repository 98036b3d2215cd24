#pragma once
// Tone curves for LDR output (docs/scene-format.md, section 3.2).

#include "tungsten/image/Image.h"

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
/// 8-bit RGB, row 0 at the top.
std::vector<uint8_t> toneMapped(const Image& image, ToneMap toneMap);
/// floor(255 f), clamped to [0, 255].
std::array<uint8_t, 3> toLdr(const Rgb& toneMapped);

} // namespace tungsten
