#pragma once
// Whole files in memory, for the loaders of scenes, meshes and images.

#include "tungsten/core/LoadWatch.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace tungsten {

/// Throws InputError naming the file if it is missing, unreadable, or no regular file (a folder, device or pipe), which
/// could go on for ever. Returns its size. Never waits.
uint64_t requireRegularFile(const std::filesystem::path& file);

/// The bytes of a regular file of up to 4 GiB; otherwise throws as above.
std::vector<char> readFileBytes(const std::filesystem::path& file, const LoadWatch& watch = {});

/// Of a file that is, or begins with, text: without the byte-order mark of UTF-8. Throws InputError for text in UTF-16
/// or UTF-32, marked or not: its first characters have zero bytes.
std::string_view utf8Of(const std::vector<char>& bytes, const std::filesystem::path& file);

} // namespace tungsten
