#pragma once
// Which images a render writes.

#include "tungsten/render/Outputs.h"

namespace tungsten {

/// One file of a film: the image of the whole gate (formats that hold several frames get all of them), one frame, all
/// frames as an array, as a sheet or as a video, or what is known about them.
struct PlannedImage {
    enum class Content { Whole, Frame, Cube, Sheet, Video, Metadata };
    std::filesystem::path file;
    Content content = Content::Whole;
    int frame = 0;
    bool linear = false; ///< not tone-mapped, where it is an 8-bit image
};

/// Every image that is written, with a `suffix` (which goes before the extension: checkpoints) only the main ones.
std::vector<PlannedImage> plannedImages(const OutputFiles& outputs, int frames, const std::string& suffix);

/// `NAME<suffix>.ext` for NAME.ext.
std::filesystem::path withSuffix(const std::filesystem::path& file, const std::string& suffix);
/// Lower case, dot included.
std::string extensionOf(const std::filesystem::path& file);

} // namespace tungsten
