#pragma once
// Light that connections brought to sensor points, shared among neighbouring ones: a density estimate on what the
// camera sees, as gathering photons is, but of connections that arrive in time.

#include "photon/surface/ReceivedLight.h"
#include "photon/view/SensorRecord.h"
#include "transport/Sensor.h"

#include "tungsten/film/Film.h"
#include "tungsten/integrator/ProgressToken.h"

namespace tungsten::photon {

/// How far apart sensor points on the same smooth surface may be to share: in the image, where below 1 pixel each pixel
/// keeps its own light and the estimate has no bias, and in the scene.
struct SharingKernel {
    float pixels, distance;
    float time = 1.0f; ///< part of a frame's width, about its middle, that is shared

    /// As wide in the scene as surface photons are gathered; shrinking from pass to pass as `factor` (of gather radii)
    /// does.
    static SharingKernel of(float gatherRadius, float factor);
};

/// Adds to the pass image, for every sensor point, the mean over the points in its kernel of what arrived there,
/// reflected by its own BSDF, times `scale`.
void shareLight(const Scene& scene, const transport::Sensor& sensor, const SensorRecord& record,
                const std::vector<ReceivedLight>& received, const SharingKernel& kernel, double scale, Film& film,
                Statistics& statistics, const ProgressToken& watch = {});

} // namespace tungsten::photon
