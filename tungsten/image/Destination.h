#pragma once
// Where a file of some name is really written: through links, or to what this process has open.

#include <filesystem>
#include <optional>

namespace tungsten {

/// The end of the links that `file` leads through, which need not exist; `file` itself where it is no link, and where
/// it is an open file (descriptorNamed). Throws InputError for circles, and for links that others have put into a
/// folder in which everybody may (/tmp).
std::filesystem::path destinationOf(const std::filesystem::path& file);

/// The descriptor of this process that a name such as /dev/stdout or /dev/fd/3 leads to.
std::optional<int> descriptorNamed(const std::filesystem::path& file);

} // namespace tungsten
