#pragma once
// The formats of outputs. One is a file that ends with its OutputFormat, and its line in Formats.cpp: what may be asked
// for, what error messages and help texts list, and what is written beside, follow from the table.

#include "tungsten/io/OutputFilm.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tungsten {

struct OutputFormat;

/// One file of a film.
struct OutputImage {
    std::filesystem::path file;
    const OutputFormat* format = nullptr; ///< none: what is known about the file before it, as text
    std::optional<int> frame{};           ///< none: the whole gate, or all frames where the format holds them
    bool linear = false;                  ///< not tone-mapped, where it is an 8-bit image
};

/// Where a file of a format can be asked for; several as a mask.
using OutputUses = unsigned;
namespace output_use {
inline constexpr OutputUses Shown = 1;  ///< 8-bit images (-o)
inline constexpr OutputUses Linear = 2; ///< images of numbers (-e)
inline constexpr OutputUses Series = 4; ///< those of single frames
inline constexpr OutputUses Sheet = 8;  ///< --sheet
inline constexpr OutputUses Video = 16; ///< --video
} // namespace output_use

struct OutputFormat {
    std::string_view extension; ///< lower case, with its dot
    OutputUses uses = 0;
    std::string_view note{};    ///< what its files hold besides the image, such as "with standard error"
    bool holdsFrames = false;   ///< in one file; else frames that are asked for have files of their own
    bool holdsArrays = false;   ///< frames as one array; else one is written beside it
    bool needsMetadata = false; ///< cannot hold them: they are written beside it
    int mostFrames = 0;         ///< in one file; 0: any number
    /// Throws InputError, before a render begins, where files of it cannot be written.
    void (*require)(const std::filesystem::path& file) = nullptr;
    /// Throws InputError naming the file.
    void (*write)(const OutputFilm& film, const OutputImage& image) = nullptr;
};

/// All of them, in the order in which texts list them.
const std::vector<const OutputFormat*>& outputFormats();

/// Of the file's extension. Throws InputError with those that are accepted if it is none of these uses.
const OutputFormat& formatOf(const std::filesystem::path& file, OutputUses uses);
/// Whether there is one.
bool hasFormat(const std::filesystem::path& file, OutputUses uses);

/// Throws InputError unless the file's extension is one of these.
void requireExtension(const std::filesystem::path& file, const std::vector<std::string>& accepted);

/// ".exr, .npz, .h5, .pfm or .npy".
std::string formatsText(OutputUses uses);
/// ".exr with standard error, .npz or .h5 with all that is known, .pfm or .npy".
std::string formatsWithNotes(OutputUses uses);

/// Lower case, dot included.
std::string extensionOf(const std::filesystem::path& file);

} // namespace tungsten
