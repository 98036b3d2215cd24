#pragma once
// Light that connections brought to sensor points, shared among neighbouring ones: a density estimate on what the
// camera sees, as gathering photons is, but of connections that arrive in time.

#include "photon/Deposits.h"
#include "photon/Sensor.h"
#include "photon/SensorRecord.h"

#include "tungsten/film/Film.h"

namespace tungsten::photon {

/// How far apart, in pixels, sensor points on the same smooth surface may be to share. Wide where few connections
/// arrive, and shrinking from pass to pass as `factor` (of gather radii) does; below 1 each point keeps its own light,
/// and the estimate has no bias.
float sharingRadius(size_t points, size_t arrivals, float factor);

/// Adds to the pass image, for every sensor point, the mean over the points within `radius` pixels of what arrived
/// there, reflected by its own BSDF, times `scale`.
void shareArrivals(const Scene& scene, const Sensor& sensor, const SensorRecord& record,
                   const std::vector<SurfaceArrival>& arrivals, float radius, double scale, Film& film,
                   Statistics& statistics);

} // namespace tungsten::photon
