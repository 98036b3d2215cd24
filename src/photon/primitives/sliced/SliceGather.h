#pragma once
// Gathering planes, volumes, balls, hypervolumes, and the beams beside them, along a camera segment.

#include "photon/primitives/beams/BeamGather.h"
#include "photon/primitives/sliced/SliceEstimate.h"

#include <optional>

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

    /// About what a record can reach.
    struct Box {
        Vec3f low, high;
    };

  private:
    SliceEstimate estimate_;
    std::vector<const SliceRecord*> slices_; ///< all but beams, by Embree's index
    std::vector<Box> boxes_;                 ///< of these
    std::vector<PhotonBeam> beams_;
    std::optional<EmbreeScene> structure_; ///< none without slices
    std::optional<BeamGather> beamGather_; ///< none without beams
};

} // namespace tungsten::photon
