#pragma once
// Sliced primitives drawn into the image along straight camera rays, a register of rays at a time.

#include "photon/primitives/Selection.h"
#include "photon/primitives/sliced/Ball.h"
#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/SliceRecord.h"
#include "photon/primitives/sliced/Volume.h"
#include "photon/raster/ImageFootprint.h"
#include "photon/view/CameraRecord.h"

#include "transport/TimeSensor.h"

#include "tungsten/scene/Scene.h"

#include <variant>

namespace tungsten::photon {

/// What a register of rays meets of a record: intersect(record, rays, emit).
using SliceKernel =
    std::variant<PlaneLanes, VolumeSliceLanes, VolumeChordLanes, HypervolumeLanes, BallSliceLanes, BallGateLanes>;

/// A record as the image sees it.
struct ImageSlice {
    LaneRecord record;
    SliceKernel kernel;
    PixelArea area;
    Rgb power;    ///< with the collapsed collisions
    bool inLanes; ///< evaluated a register at a time; otherwise ray by ray
};

/// For one pass's gate and records.
class SliceFootprints {
  public:
    /// `sensor`: with the pass's gate; `scale`: on every power.
    SliceFootprints(const Scene& scene, const transport::TimeSensor& sensor, double scale);

    /// None if no ray can meet it in time. `shares`: by frame (FrameRoulette).
    [[nodiscard]] std::optional<ImageSlice> prepare(const SliceRecord& flights, std::span<const float> shares) const;

  private:
    /// Of a ball on a light: its intensity, but for the cosine, and how that goes with direction, if registers of rays
    /// can tell.
    struct LightAtBall {
        Rgb intensity{1.0f};
        LaneRecord::Leaving leaving = LaneRecord::Leaving::Phase;
        float leastCosine = 0.0f;
        bool known = true;
    };
    [[nodiscard]] LightAtBall lightAt(const SliceRecord& ball) const;
    /// The camera is so far that its distance would take digits from what counts.
    [[nodiscard]] bool farAway(const SliceRecord& flights, double speed) const;
    /// The gate is met at one length of each frame, or at the delta gate; otherwise inside frames.
    [[nodiscard]] bool atLengths(const SliceRecord& flights) const;
    [[nodiscard]] LaneTimes timesOf(const SliceRecord& flights, double speed, double common) const;
    [[nodiscard]] SliceKernel kernelOf(const SliceRecord& flights) const;
    [[nodiscard]] std::optional<PixelArea> areaOf(const SliceRecord& flights, float length) const;

    const Scene& scene_;
    TimeGate gate_;
    double scale_;
    std::optional<ImageFootprint> footprint_; ///< of pinholes; other cameras see everything everywhere
    bool warped_, delta_, weighed_;           ///< weighed_: times by a response
};

/// Adds what the recorded rays see of the records, times `scale`, to the pass image; returns how many meetings brought
/// something. `radius`: of the beams among them.
uint64_t splatSlices(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecord& record,
                     const std::vector<SliceRecord>& records, const Radii& radius, double scale, Film& film,
                     const ProgressToken& watch = {});

} // namespace tungsten::photon
