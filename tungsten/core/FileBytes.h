#pragma once
// Whole files in memory, for the loaders of scenes, meshes and images.

#include "tungsten/core/LoadWatch.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace tungsten {

/// Throws InputError naming the file if it is missing, unreadable, or no regular file (a folder, device or pipe), which
/// could go on for ever. Returns its size. Never waits.
uint64_t requireRegularFile(const std::filesystem::path& file);

/// Looks at how a file begins (up to 4 KiB of it) and at its size, and throws for what is not of its kind.
using FileCheck = std::function<void(std::string_view start, uint64_t size)>;

/// The bytes of a regular file of up to 4 GiB that fits into the memory that is available; otherwise throws as above.
/// `check` comes before anything else is read. `watch` is told.
std::vector<char> readFileBytes(const std::filesystem::path& file, const LoadWatch& watch = {},
                                const FileCheck& check = {});

/// A check of texts: throws for zero bytes where a file that goes on behind its start begins with some.
void requireText(const std::filesystem::path& file, std::string_view start, uint64_t size);

/// Of a file that is, or begins with, text: without the byte-order mark of UTF-8. Throws InputError for text in UTF-16
/// or UTF-32, marked or not: its first characters have zero bytes.
std::string_view utf8Of(std::string_view text, const std::filesystem::path& file);
inline std::string_view utf8Of(const std::vector<char>& bytes, const std::filesystem::path& file) {
    return utf8Of(std::string_view(bytes.data(), bytes.size()), file);
}

} // namespace tungsten
