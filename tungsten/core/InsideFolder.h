#pragma once
// Which files a scene may name.

#include <filesystem>

namespace tungsten {

/// Whether the file lies in the folder or in one below it, links followed; neither needs to exist. An empty folder is
/// the current one.
bool isInside(const std::filesystem::path& file, const std::filesystem::path& folder);

} // namespace tungsten
