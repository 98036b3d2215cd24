#pragma once
// Which frames of a sequence a record is drawn in.

#include "photon/primitives/sliced/SliceRecord.h"

#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/scene/Scene.h"

#include <span>

namespace tungsten::photon {

/// A record is seen in all frames from some time on, but fades: where it is darker than what others of its shape
/// bring to a frame on average, it is drawn at random, as often as it is bright, and weighs more. A film then costs
/// what its light calls for. How bright it is is a guess (logSliceLight): a part of the choice is even over all that
/// can arrive, so that nothing is left out for good and no weight is above 1 / tuning::EvenInFrames.
class FrameRoulette {
  public:
    FrameRoulette(const Scene& scene, const TimeGate& gate, const std::vector<SliceRecord>& records,
                  const ProgressToken& watch = {});

    /// What a record's power is multiplied by, by frame: 0 where it is not drawn. Empty: all are drawn.
    [[nodiscard]] std::span<const float> of(size_t record) const {
        return std::span(factors_).subspan(factors_.empty() ? 0 : record * frames_, factors_.empty() ? 0 : frames_);
    }

  private:
    void chooseAmong(FlightShape shape, const std::vector<SliceRecord>& records);
    /// Probability of what is so bright among others of this mean.
    [[nodiscard]] static double shareOf(double light, double mean);

    size_t frames_;
    std::vector<float> factors_; ///< of all frames of every record
};

} // namespace tungsten::photon
