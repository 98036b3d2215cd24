#pragma once
// Films as MP4 or GIF, by the program ffmpeg.

#include "tungsten/core/Types.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace tungsten {

/// Throws InputError about `video` unless there is an ffmpeg on PATH.
void requireFfmpeg(const std::filesystem::path& video);

/// So that a film of this many frames lasts about five seconds: 4 to 30.
double framesPerSecond(int frames);

/// Writes .mp4 or .gif. `frameOf` gives 8-bit RGB, row 0 at the top, of `size` pixels. ffmpeg is started without a
/// shell and gets the frames one by one; what it makes is renamed to `file` when it is whole. Throws InputError with
/// what ffmpeg says if it fails.
void writeVideo(const std::filesystem::path& file, const Vec2i& size, int frames,
                const std::function<std::vector<uint8_t>(int)>& frameOf);

} // namespace tungsten
