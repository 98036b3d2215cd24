#pragma once
// What every walk from the camera keeps: where it has got to, and where its light goes.

#include "path/PathSettings.h"
#include "path/PixelSink.h"

#include "tungsten/scene/Scene.h"

namespace tungsten::path {

class CameraPath {
  protected:
    CameraPath(const Scene& scene, PixelSink& sink, PathCounters& counters, Sampler sampler)
        : scene_(scene), sink_(sink), counters_(counters), sampler_(sampler) {}

    /// Camera segments count, or are over.
    [[nodiscard]] bool timed() const { return scattered_ || !scene_.transport.cameraUnwarped; }

    const Scene& scene_;
    PixelSink& sink_;
    PathCounters& counters_;
    Sampler sampler_;

    Ray ray_;
    Region region_;
    Rgb throughput_{1.0f};
    double time_ = 0.0; ///< from the sensor so far
    int interactions_ = 0;
    int flights_ = 0; ///< distances sampled in media since the last surface
    int mediumScatters_ = 0;
    bool scattered_ = false; ///< a smooth vertex exists: the camera side of the path is over
};

} // namespace tungsten::path
