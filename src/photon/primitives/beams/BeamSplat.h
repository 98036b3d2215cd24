#pragma once
// Photon beams brought to the pixels instead of pixels to the beams: for straight rays from one point.

#include "photon/primitives/Radii.h"
#include "photon/primitives/beams/PhotonBeam.h"
#include "photon/view/CameraRecord.h"
#include "transport/TimeSensor.h"

#include "tungsten/film/Film.h"

namespace tungsten::photon {

/// Adds what BeamGather would gather along the straight rays of each record to the pass image, times `scale`. Each beam
/// visits the pixels that its ribbon covers. Returns the number of beams gathered, one per pixel and beam. `sensor` has
/// the pass's gate.
uint64_t splatBeams(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                    const std::vector<PhotonBeam>& beams, const Radii& radii, double scale, Film& film,
                    const ProgressToken& watch = {});

} // namespace tungsten::photon
