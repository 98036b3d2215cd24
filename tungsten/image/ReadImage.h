#pragma once
// Image files in: textures, and what renders have written. All throw InputError naming the file.

#include "tungsten/image/Image.h"

#include <filesystem>
#include <string>

namespace tungsten {

/// `PF` or `Pf`; the scale field is ignored.
Image readPfm(const std::filesystem::path& file);

/// The string attribute `metadata` of the first part; empty: there is none.
std::string readExrMetadata(const std::filesystem::path& file);
/// RGB of part `part`, layer `layer` (such as "" or "stderr."). Missing channels: InputError.
Image readExr(const std::filesystem::path& file, int part = 0, const std::string& layer = "");
int exrPartCount(const std::filesystem::path& file);

} // namespace tungsten
