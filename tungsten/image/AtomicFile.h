#pragma once
// Files that appear whole or not at all.

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>

namespace tungsten {

/// Where the file is; "." for a bare name.
std::filesystem::path folderOf(const std::filesystem::path& file);

/// Throws InputError if something that is not a file (a folder, device or pipe) has this name.
void requireReplaceable(const std::filesystem::path& file);

/// Whether files can be made in the folder, which its permissions alone do not tell: makes one and removes it.
bool takesFiles(const std::filesystem::path& folder);

/// `write` fills a temporary file in the destination's folder, created for this alone under a random name. What it
/// wrote is checked, brought to the disk and renamed to the destination; links lead there (destinationOf), and open
/// files are written to. On any failure, a full disk among them, the destination stays as it was, nothing is left
/// behind, and InputError names it. Streams can be sought.
void writeAtomically(const std::filesystem::path& destination, const std::function<void(std::ostream&)>& write);

/// Removes temporary files in the folder whose writers are gone (killed while writing).
void removeAbandonedFiles(const std::filesystem::path& folder);

/// Writes text by way of a temporary file and rename.
void writeTextFile(const std::filesystem::path& file, const std::string& text);

} // namespace tungsten
