#pragma once
// How many records a base leaves, by what one of them brings inside the gate.

#include "photon/primitives/sliced/SliceKind.h"

#include "tungsten/scene/Scene.h"

#include <span>

namespace tungsten::photon {

/// Radiance at a time that a record adds to a ray, about, without what all of its shape share: the power that gets
/// there, a ball's spread over its sphere. 0 where it cannot be seen yet.
float sliceLight(const Scene& scene, const CollapsedFlights& record, double time);

/// By the base alone, never by lengths that a record integrates over: their expectation is the same for any number
/// above 0. Where a record is brighter there are more of them, so that all are about equally bright in the image.
class RecordCounts {
  public:
    /// `gate`: the pass's. Every base that counts leaves one record, until measure() has been called.
    RecordCounts(const Scene& scene, const TimeGate& gate);

    /// From records of a few paths, one for every base that counts; `classes`: how many there are to be for each of
    /// these.
    void measure(std::span<const CollapsedFlights> records, const SliceClasses& classes);
    /// Expected number of records like this one.
    [[nodiscard]] float expected(const CollapsedFlights& record) const;

  private:
    [[nodiscard]] float lightOf(const CollapsedFlights& record) const;

    const Scene& scene_;
    TimeGate gate_;
    /// Shapes, and balls that share their paths.
    static constexpr size_t Groups = 6;
    [[nodiscard]] static size_t group(const CollapsedFlights& record) {
        return record.shape == FlightShape::Ball && record.shared ? Groups - 1 : size_t(record.shape);
    }

    std::array<double, Groups> lightOfOne_{}; ///< of what leaves one record, by group
};

} // namespace tungsten::photon
