#pragma once
// Image files out, format by format. Every writer goes through writeAtomically(): an interrupted or failed write never
// destroys an earlier result. All throw InputError naming the file.

#include "tungsten/image/Image.h"
#include "tungsten/image/ToneMap.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tungsten {

/// 8-bit RGB.
void writePng(const std::filesystem::path& file, const Image& image, ToneMap toneMap);

/// `PF`, little-endian floats, rows bottom to top.
void writePfm(const std::filesystem::path& file, const Image& image);

/// One part of an EXR file: an image with its standard error and the interval of time it covers.
struct ExrPart {
    std::string name;    ///< such as "frame.0007"; unused for single parts
    Image colour;        ///< channels R, G, B
    Image standardError; ///< layer stderr.R, stderr.G, stderr.B; may be empty
    bool hasTime = false;
    double timeStart = 0.0, timeEnd = 0.0; ///< attributes timeStart and timeEnd
    Image bias{}, biasError{}; ///< layers bias.R, ... and its standard error, biasStderr.R, ...; may be empty
};
/// Float channels, ZIP compression. One part: an ordinary file; several: a multi-part file. `metadata` becomes a string
/// attribute of the first part, unless it is empty.
void writeExr(const std::filesystem::path& file, const std::vector<ExrPart>& parts, const std::string& metadata = "");
/// The same of parts that are made when they are written, so that few are in memory: `part` is asked twice for each.
void writeExr(const std::filesystem::path& file, int parts, const std::function<ExrPart(int)>& part,
              const std::string& metadata = "");

/// (frames, height, width, 3) float32 in C order, as numpy.load reads it.
void writeNpy(const std::filesystem::path& file, const std::vector<Image>& frames);
/// The same of at least one frame of one size, each made when it is written.
void writeNpy(const std::filesystem::path& file, int frames, const std::function<Image(int)>& frame);

} // namespace tungsten
