#pragma once
// Checks of image files before a decoder sees them: what the decoders believe without looking. All throw InputError.

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace tungsten {

/// No format but PNG packs more texels into a byte (GIF comes closest).
inline constexpr int64_t MostTexelsPerByte = 1 << 12;

/// Rejects sizes above 2^27 texels, and above what a file of so many bytes can hold.
void requirePlausibleSize(int64_t width, int64_t height, size_t fileBytes, const std::filesystem::path& file,
                          int64_t texelsPerByte = MostTexelsPerByte);

bool isPng(std::string_view bytes);
/// Texels a byte of a PNG can hold: deflate reaches 1032 : 1, and a texel has from 1 to 64 bits by its header.
int64_t pngTexelsPerByte(std::string_view bytes);
/// Chunks that end beyond the file: stb allocates what their lengths claim before it reads them.
void requireSanePngChunks(std::string_view bytes, const std::filesystem::path& file);

bool isJpeg(std::string_view bytes);
/// Huffman tables of more than 256 codes: stb writes them past the end of its own.
void requireSaneJpegTables(std::string_view bytes, const std::filesystem::path& file);

/// Attributes that end beyond the file: OpenEXR allocates what their sizes claim before it reads them.
void requireSaneExrAttributes(std::string_view bytes, const std::filesystem::path& file);

} // namespace tungsten
