#pragma once
// Whole files in memory, for the loaders of meshes and images.

#include <filesystem>
#include <vector>

namespace tungsten {

/// The bytes of a regular file. Throws InputError naming it if it is missing, not a regular file, unreadable or above 4
/// GiB.
std::vector<char> readFileBytes(const std::filesystem::path& file);

} // namespace tungsten
