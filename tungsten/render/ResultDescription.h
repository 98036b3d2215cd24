#pragma once
// What an image file says about itself: the metadata of docs/results.md.

#include "tungsten/film/ResultFile.h"
#include "tungsten/scene/Scene.h"

#include <string>
#include <vector>

namespace tungsten {

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
