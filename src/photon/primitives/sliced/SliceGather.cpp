#include "photon/primitives/sliced/SliceGather.h"

#include "photon/primitives/sliced/ShortFlights.h"

namespace tungsten::photon {

namespace {

/// What flights that end can reach: a parallelepiped's box.
EmbreeSlices::Box reachedByShort(const SliceRecord& flights, const std::array<double, 4>& ends, float length) {
    EmbreeSlices::Box box{flights.base, flights.base};
    for (int i = 0; i < flights.flights(); ++i) {
        const Vec3f flight = flights.directions[size_t(i)] * std::min(float(ends[size_t(i)]), length);
        for (int axis = 0; axis < 3; ++axis) (flight[axis] < 0.0f ? box.low : box.high)[axis] += flight[axis];
    }
    return box;
}

/// Everything that flights of this total length from the base can reach: the hull of their ends, or a sphere.
EmbreeSlices::Box reached(const SliceRecord& flights, const Medium& medium, float length) {
    const std::array<double, 4> ends = flightEnds(flights, medium);
    if (flights.shape == FlightShape::Ball) length = std::min(length, float(ends[0]));
    EmbreeSlices::Box box{flights.base, flights.base};
    const auto include = [&](const Vec3f& point) {
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], point[axis]);
            box.high[axis] = std::max(box.high[axis], point[axis]);
        }
    };
    if (flights.shape == FlightShape::Ball) {
        include(flights.base - Vec3f(length));
        include(flights.base + Vec3f(length));
    } else {
        for (int i = 0; i < flights.flights(); ++i) include(flights.base + flights.directions[size_t(i)] * length);
    }
    if (flights.shortFlights && flights.shape != FlightShape::Ball) {
        const EmbreeSlices::Box other = reachedByShort(flights, ends, length);
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::max(box.low[axis], other.low[axis]);
            box.high[axis] = std::min(box.high[axis], other.high[axis]);
        }
    }
    const Vec3f margin = (box.high - box.low) * 1e-5f;
    return {box.low - margin, box.high + margin};
}

} // namespace

std::vector<PhotonBeam> beamsAmong(const Scene& scene, const std::vector<SliceRecord>& records) {
    std::vector<PhotonBeam> beams;
    for (const SliceRecord& flights : records)
        if (flights.shape == FlightShape::Beam)
            beams.push_back({flights.time, flights.base, flights.directions[0], flights.power, flights.lengths[0],
                             std::min(flights.reach, visibleReach(scene.media[size_t(flights.medium)])), flights.bounce,
                             flights.medium});
    return beams;
}

SliceGather::SliceGather(const Scene& scene, const transport::TimeSensor& sensor,
                         const std::vector<SliceRecord>& records, const Radii& radius, bool fewRays)
    : estimate_(scene, sensor), beams_(beamsAmong(scene, records)) {
    std::vector<EmbreeSlices::Box> boxes;
    const TimeGate& gate = sensor.gate;
    for (const SliceRecord& flights : records) {
        const Medium& medium = scene.media[size_t(flights.medium)];
        if (flights.shape == FlightShape::Beam) continue;
        const double left = gate.steadyState ? std::numeric_limits<double>::infinity()
                                             : (gate.end() - flights.time) * double(medium.speedOfLight);
        const float length = float(std::min(left, double(visibleReach(medium))));
        if (!(length > 0.0f)) continue;
        boxes.push_back(reached(flights, medium, length));
        slices_.push_back(&flights);
    }
    if (!slices_.empty()) structure_ = std::make_unique<EmbreeSlices>(std::move(boxes));
    if (!beams_.empty()) beamGather_ = std::make_unique<BeamGather>(scene, sensor, beams_, radius, fewRays);
}

uint64_t SliceGather::gather(const CameraSegment& segment, FrameSums& sums) const {
    uint64_t gathered = beamGather_ ? beamGather_->gather(segment, sums) : 0;
    if (!structure_) return gathered;
    struct GatherQuery {
        const SliceGather& gather;
        const CameraSegment& segment;
        FrameSums& sums;
        uint64_t& gathered;
    } query{*this, segment, sums, gathered};
    const auto meet = [](void* user, uint32_t index) {
        const GatherQuery& m = *static_cast<GatherQuery*>(user);
        if (m.gather.estimate_.add(*m.gather.slices_[index], m.segment, m.sums)) ++m.gathered;
    };
    structure_->query(segment, meet, &query);
    return gathered;
}

} // namespace tungsten::photon
