#pragma once
// Path reuse between neighbouring visible points of the light that connections brought there: a density estimate on
// what the camera sees, as gathering photons is, but of connections that arrive in time.

#include "photon/surface/SurfaceConnections.h"
#include "photon/view/CameraRecord.h"
#include "transport/TimeSensor.h"

#include "tungsten/film/Film.h"
#include "tungsten/integrator/ProgressToken.h"

namespace tungsten::photon {

/// How far apart visible points on the same smooth surface may be to reuse each other's connections: in the image,
/// where below 1 pixel each pixel keeps its own light and the estimate has no bias, and in the scene.
struct ReuseKernel {
    float pixels, distance;
    float time = 1.0f; ///< central part of a frame whose connections are reused; below 1 where the bias is measured

    /// A kernel as wide in the scene as surface photons are gathered; it shrinks from pass to pass as `factor` (of
    /// gather radii) does.
    static ReuseKernel of(float gatherRadius, float factor);
};

/// Adds to the pass image, for every visible point, the mean over the points in its kernel of what arrived there,
/// reflected by its own BSDF, times `scale`.
void reuseAcrossPixels(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecord& record,
                       const std::vector<ConnectionRecord>& received, const ReuseKernel& kernel, double scale,
                       Film& film, Statistics& statistics, const ProgressToken& watch = {});

} // namespace tungsten::photon
