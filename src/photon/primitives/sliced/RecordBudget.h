#pragma once
// How many records a base leaves, by what one of them brings inside the gate.

#include "photon/primitives/sliced/SliceKind.h"

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

} // namespace tungsten::photon
