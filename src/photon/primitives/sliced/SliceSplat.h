#pragma once
// Sliced primitives drawn into the image along straight camera rays, a register of rays at a time.

#include "photon/primitives/Radii.h"
#include "photon/primitives/sliced/SliceRecord.h"
#include "photon/view/CameraRecord.h"
#include "transport/TimeSensor.h"

namespace tungsten::photon {

/// Adds what the recorded rays see of the records, times `scale`, to the pass image; returns how many meetings brought
/// something. `radius`: of the beams among them.
uint64_t splatSlices(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecord& record,
                     const std::vector<SliceRecord>& records, const Radii& radius, double scale, Film& film,
                     const ProgressToken& watch = {});

} // namespace tungsten::photon
