#pragma once
// Records of collapsed flights as images see them.

#include "photon/primitives/sliced/SliceWeights.h"
#include "photon/raster/ImageFootprint.h"

#include "tungsten/scene/Scene.h"

namespace tungsten::photon {

/// A record as the image sees it.
struct ImageSlice {
    LaneRecord record;
    PixelArea area;
    float residual;     ///< path length left at the base, at the delta gate
    Rgb power;          ///< with the collapsed collisions
    float width;        ///< of the temporal kernel, as a length: 0 for what meets the gate itself
    bool ball, inLanes; ///< inLanes: evaluated a register at a time; otherwise ray by ray
};

/// For one pass's gate and records.
class SliceFootprints {
  public:
    /// `gate`: the pass's; `scale`: on every power.
    SliceFootprints(const Scene& scene, const TimeGate& gate, double scale);

    /// None if no ray can meet it in time.
    [[nodiscard]] std::optional<ImageSlice> prepare(const CollapsedFlights& flights) const;

  private:
    [[nodiscard]] std::optional<PixelArea> areaOf(const CollapsedFlights& flights, float length) const;

    const Scene& scene_;
    TimeGate gate_;
    double scale_;
    std::optional<ImageFootprint> footprint_; ///< of pinholes; other cameras see everything everywhere
    bool warped_, delta_;
};

} // namespace tungsten::photon
