#pragma once
// Checks of image files before a decoder sees them: what the decoders believe without looking. All throw InputError.

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace tungsten {

/// Rejects sizes above 2^27 texels, and above what a file of these bytes can hold by its format.
void requirePlausibleSize(int64_t width, int64_t height, std::string_view bytes, const std::filesystem::path& file);

bool isPng(std::string_view bytes);
/// Chunks that end beyond the file: stb allocates what their lengths claim before it reads them.
void requireSanePngChunks(std::string_view bytes, const std::filesystem::path& file);

bool isJpeg(std::string_view bytes);
/// Huffman tables of more than 256 codes: stb writes them past the end of its own.
void requireSaneJpegTables(std::string_view bytes, const std::filesystem::path& file);

bool isRadiance(std::string_view bytes);
/// Runs of no length, or beyond the end of the file: stb never gets past them.
void requireSaneRadianceRuns(std::string_view bytes, int width, int height, const std::filesystem::path& file);

/// Attributes that end beyond the file: OpenEXR allocates what their sizes claim before it reads them.
void requireSaneExrAttributes(std::string_view bytes, const std::filesystem::path& file);

} // namespace tungsten
