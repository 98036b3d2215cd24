#pragma once
// What cannot arrive while the sensor is open, by lower bounds on the time of flight, and leaving it out.

#include "tungsten/integrator/Features.h"

#include <vector>

namespace tungsten {

/// By emitter: no light of it arrives before this time, whatever its way. The start of its pulse, and the straight way
/// to the sensor at the highest speed. With `camera_unwarped` the camera's segments do not count, and mirrors or panes
/// at the sensor may be all that light meets: the start of the pulse alone.
std::vector<double> earliestArrivals(const Scene& scene, const SceneFacts& facts);

/// No light that leaves a surface of the scene arrives before this time; with `camera_unwarped`, as above, the first
/// pulse's start. Infinity where there is neither a surface nor a pulse.
double earliestFromSurfaces(const Scene& scene, const SceneFacts& facts);

/// By medium: no light that gets into it arrives before this time. Paths that do not start in it get there through a
/// surface that bounds it: the straight ways from an emitter to such a surface's box, and from there to the sensor.
/// With `camera_unwarped`, or where the camera or an emitter is in it, the first pulse's start. Infinity: no surface
/// bounds it.
std::vector<double> earliestThroughMedia(const Scene& scene, const SceneFacts& facts);

/// Excludes the emitters, surfaces, media and frames that light of the scene misses (nothing if the facts hold
/// everything), and says so. `end`: the sensor is closed from then on.
void excludeLate(const Scene& scene, double end, SceneFacts& facts, Features& features);

/// When the sensor has counted its last light: the end of the gate, or of its response.
double lastTime(const Scene& scene);

} // namespace tungsten
