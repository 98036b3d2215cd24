#pragma once
// What an image file says about itself: the metadata of docs/results.md.

#include "tungsten/film/Film.h"
#include "tungsten/scene/Scene.h"

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

/// An average over `frames` frames as the scene's outputs want it: as it is, or as their integral.
Image inOutputUnits(Image average, const Scene& scene, int frames);

/// What a result came from.
struct ResultOrigin {
    const Scene& scene;
    std::string integrator; ///< type
    std::string sceneText;  ///< JSON after --set
    std::string command;    ///< may be empty
    std::string statistics; ///< JSON, as of --stats
};

/// The metadata: JSON.
std::string describeResult(const ResultOrigin& origin);

/// Edges of the frames in the scene's unit of time, one more than there are frames. Steady state: from -inf to inf.
std::vector<double> frameEdges(const TimeGate& gate);
/// What a unit of time is, if light outside media has the speed of light in vacuum; 0: the scene does not say how long
/// its unit of length is.
double picosecondsPerTime(const Scene& scene);
/// The same edges in picoseconds; none where picosecondsPerTime() is 0.
std::vector<double> frameEdgesInPicoseconds(const Scene& scene);
/// All that a result file holds, the bias where `bias` has frames. Films, scene and metadata must outlive it.
ResultContent resultContent(const Film& film, const Film& bias, const Scene& scene, const std::string& metadata);
/// The means of batches in output units: (batch, frame, row of blocks, column of blocks, channel).
ResultContent::Array batchMeans(const Film& film, const Scene& scene);
/// What a pixel of a frame holds.
std::string quantityText(const Scene& scene);

/// Processor, threads and system of this machine.
std::string machineText();
/// Version, compiler and build type.
std::string buildText();

} // namespace tungsten
