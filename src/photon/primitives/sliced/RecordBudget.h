#pragma once
// How bright records are inside the gate: by that a base leaves more or fewer of them, and each is drawn in more or
// fewer frames.

#include "photon/primitives/sliced/SliceRecord.h"
#include "photon/primitives/sliced/Slices.h"

#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/scene/Scene.h"

#include <optional>
#include <span>

namespace tungsten::photon {

/// Path length that is left at a time beyond the distance from a record's base to the camera, at the speed of its
/// medium; where the camera's leg does not count, or is not known, all that is left. Below 0 nothing shows, but for
/// other speeds on the way.
double lengthToSpare(const Scene& scene, const SliceRecord& record, double time);

/// Logarithm of the radiance at a time that a record adds to a ray, about, without what all of its shape share: the
/// power that gets there, a ball's spread over its sphere. A guess, since how much of the way lies in the medium
/// depends on where it leaves: the camera's straight leg does not where the camera is elsewhere. Finite: what is chosen
/// by it needs no number of its own for what is too dark for a float.
double logSliceLight(const Scene& scene, const SliceRecord& record, double time);

/// The number of records of a base depends on the base alone, never on lengths that a record integrates over: their
/// expectation is the same for any number above 0. Where a record is brighter there are more of them, so that all are
/// about equally bright in the image; but never so few that one weighs more than 1 / tuning::LeastPerBase.
class RecordBudget {
  public:
    /// `gate`: the pass's. Every base that counts leaves one record, until measure() has been called.
    RecordBudget(const Scene& scene, const TimeGate& gate);

    /// From records of a few paths, one for every base that counts; `classes`: how many there are to be for each of
    /// these.
    void measure(std::span<const SliceRecord> records, const SliceClasses& classes);
    /// Expected number of records like this one.
    [[nodiscard]] float expected(const SliceRecord& record) const;

  private:
    [[nodiscard]] double logLightOf(const SliceRecord& record) const;

    const Scene& scene_;
    TimeGate gate_;
    /// Shapes, and balls that share their paths.
    static constexpr size_t Groups = 6;
    [[nodiscard]] static size_t group(const SliceRecord& record) {
        return record.shape == FlightShape::Ball && record.shared ? Groups - 1 : size_t(record.shape);
    }

    std::array<std::optional<double>, Groups> logLightOfOne_{}; ///< of what leaves one record, by group
};

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
