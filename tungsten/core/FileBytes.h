#pragma once
// Whole files in memory, for the loaders of scenes, meshes and images.

#include "tungsten/core/LoadWatch.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace tungsten {

/// Throws InputError naming the file if it is missing, unreadable, or no regular file (a folder, device or pipe), which
/// could go on for ever. Returns its size. Never waits.
uint64_t requireRegularFile(const std::filesystem::path& file);

/// The bytes of a regular file of up to 4 GiB; otherwise throws as above.
std::vector<char> readFileBytes(const std::filesystem::path& file, const LoadWatch& watch = {});

} // namespace tungsten
