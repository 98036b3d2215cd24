#pragma once
// What every walk from the camera keeps: where it has got to, and where its light goes.

#include "path/PathSettings.h"
#include "path/PixelSink.h"

#include "tungsten/scene/Scene.h"

namespace tungsten::path {

struct CameraPath {
    CameraPath(const Scene& wholeScene, PixelSink& ownSink, PathCounters& ownCounters, const Sampler& ownSampler)
        : scene(wholeScene), sink(ownSink), counters(ownCounters), sampler(ownSampler) {}

    /// Camera segments count, or are over.
    [[nodiscard]] bool timed() const { return scattered || !scene.transport.cameraUnwarped; }
    /// The time at the end of a straight way of this length.
    [[nodiscard]] double timeAfter(float length) const {
        return timed() ? time + double(length) / double(region.speed) : time;
    }

    const Scene& scene;
    PixelSink& sink;
    PathCounters& counters;
    Sampler sampler;

    Ray ray;
    Region region;
    Rgb throughput{1.0f};
    double time = 0.0; ///< from the sensor so far
    int interactions = 0;
    int flights = 0; ///< distances sampled in media since the last surface
    int mediumScatters = 0;
    bool scattered = false; ///< a smooth vertex exists: the camera side of the path is over
};

} // namespace tungsten::path
