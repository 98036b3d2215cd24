#pragma once
// Image files. Every writer writes to a temporary file beside the target and renames it: an interrupted write never destroys an
// earlier result. All throw InputError naming the file.

#include "tungsten/film/Film.h"
#include "tungsten/film/ToneMap.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tungsten {

/// 8-bit RGB, row 0 at the top.
void writePng(const std::filesystem::path& file, const Image& image, ToneMap toneMap);
/// `PF`, little-endian floats, rows bottom to top.
void writePfm(const std::filesystem::path& file, const Image& image);
Image readPfm(const std::filesystem::path& file);

/// One part of a multi-part EXR: a frame with its standard error and the interval of time it covers.
struct ExrPart {
    std::string name;                   ///< e.g. "frame.0007"; a single part may be ""
    const Image* colour = nullptr;      ///< channels R, G, B
    const Image* standardError = nullptr; ///< layer stderr.R, stderr.G, stderr.B; optional
    bool hasTime = false;
    double timeStart = 0.0, timeEnd = 0.0; ///< float attributes timeStart, timeEnd (double attributes)
};
/// Float channels, ZIP, one part per frame.
void writeExr(const std::filesystem::path& file, const std::vector<ExrPart>& parts);
/// All RGB(A) float images of an EXR: `part` index, channel prefix ("" or "stderr.").
Image readExr(const std::filesystem::path& file, int part = 0, const std::string& layerPrefix = "");

/// (frames, height, width, 3) float32, C order, that numpy.load reads; frames written in order without one big copy.
void writeNpy(const std::filesystem::path& file, const std::vector<Image>& frames);

/// Writes bytes by way of a temporary file and rename.
void writeFileAtomically(const std::filesystem::path& file, const std::string& bytes);

} // namespace tungsten
