#pragma once
// A film with all that is known about it, in one file: docs/results.md has the layout.

#include "tungsten/film/Film.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tungsten {

/// Of the layout that docs/results.md describes; grows when a reader of the one before would misread it.
inline constexpr int ResultVersion = 1;

/// What a result file holds. Images are asked for one after the other, so that no second film is in memory.
struct ResultContent {
    struct Images {
        std::string name;
        std::function<Image(int)> frame;
    };
    struct Vector {
        std::string name;
        std::vector<double> values;
    };
    struct Array {
        std::string name;
        std::vector<size_t> shape;
        std::vector<float> values;
    };
    int width = 0, height = 0, frames = 0;
    int channels = 3;            ///< 3, or 1: of the images' pixels, which are grey, the first
    std::vector<Images> images;  ///< each (frames, height, width, channels) of 32-bit floats
    std::vector<Vector> vectors; ///< 64-bit floats
    std::string metadata;        ///< JSON
    std::vector<Array> arrays{};
};

/// Row-major, channels innermost.
std::vector<float> valuesOf(const Image& image, int channels);

/// A zip of one NAME.npy for every array, stored, and metadata.json: what numpy.load reads. Throws InputError naming
/// the file.
void writeNpz(const std::filesystem::path& file, const ResultContent& content);

/// HDF5 of one dataset for every array, images in deflated tiles of one frame each, and the string `metadata`. The file
/// is in memory until it is written. Throws InputError naming the file.
void writeHdf5(const std::filesystem::path& file, const ResultContent& content);

} // namespace tungsten
