#pragma once
// Volume photons brought to the pixels instead of pixels to the photons: for straight rays from one point.

#include "photon/primitives/Radii.h"
#include "photon/store/Store.h"
#include "photon/view/CameraRecord.h"
#include "transport/TimeSensor.h"

#include "tungsten/film/Film.h"

namespace tungsten::photon {

/// Adds what PointGather would gather along the straight rays of each record to the pass image, times `scale`. Each
/// photon visits the pixels that its kernel covers: an order of magnitude cheaper than a hierarchy over the photons and
/// a traversal per ray (benchmarks/micro, gather). Returns the number of photons gathered, one per pixel and photon.
/// `sensor` has the pass's gate.
uint64_t splatPhotons(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                      const std::vector<Photon>& photons, const Radii& radii, double scale, Film& film,
                      const ProgressToken& watch = {});

} // namespace tungsten::photon
