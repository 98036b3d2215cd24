#pragma once
// Gathering planes, volumes, balls, hypervolumes, and the beams beside them, along a camera segment.

#include "photon/primitives/beams/BeamGather.h"
#include "photon/primitives/sliced/EmbreeSlices.h"
#include "photon/primitives/sliced/SliceEstimate.h"

#include <memory>

namespace tungsten::photon {

/// The beams among the records.
std::vector<PhotonBeam> beamsAmong(const Scene& scene, const std::vector<SliceRecord>& records);

class SliceGather {
  public:
    /// `records` must stay alive; `radius`: of beams. As BeamGather.
    SliceGather(const Scene& scene, const transport::TimeSensor& sensor, const std::vector<SliceRecord>& records,
                const Radii& radius, bool fewRays = false);

    /// Adds what the records bring to the segment, times the gate's width; returns how many brought something.
    uint64_t gather(const CameraSegment& segment, FrameSums& sums) const;

  private:
    SliceEstimate estimate_;
    std::vector<const SliceRecord*> slices_; ///< all but beams
    std::vector<PhotonBeam> beams_;
    std::unique_ptr<EmbreeSlices> structure_;
    std::unique_ptr<BeamGather> beamGather_;
};

} // namespace tungsten::photon
