#include "photon/primitives/sliced/SliceGather.h"

#include "photon/primitives/sliced/RaySliceQuery.h"

namespace tungsten::photon {

namespace {

/// What flights that end can reach: a parallelepiped's box.
SliceGather::Box reachedByShort(const SliceRecord& flights, const std::array<double, 4>& ends, float length) {
    SliceGather::Box box{flights.base, flights.base};
    for (int i = 0; i < flights.flights(); ++i) {
        const Vec3f flight = flights.directions[size_t(i)] * std::min(float(ends[size_t(i)]), length);
        for (int axis = 0; axis < 3; ++axis) (flight[axis] < 0.0f ? box.low : box.high)[axis] += flight[axis];
    }
    return box;
}

/// Everything that flights of this total length from the base can reach: the hull of their ends, or a sphere.
SliceGather::Box reached(const SliceRecord& flights, const Medium& medium, float length) {
    const std::array<double, 4> ends = flightEnds(flights, medium);
    if (flights.shape == FlightShape::Ball) length = std::min(length, float(ends[0]));
    SliceGather::Box box{flights.base, flights.base};
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
        const SliceGather::Box other = reachedByShort(flights, ends, length);
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::max(box.low[axis], other.low[axis]);
            box.high[axis] = std::min(box.high[axis], other.high[axis]);
        }
    }
    const Vec3f margin = (box.high - box.low) * 1e-5f;
    return {box.low - margin, box.high + margin};
}

/// What the callback sees: its first member is the query's context, so that Embree's address of it is the query's.
struct SliceQuery {
    embree::Context context;
    const SliceEstimate& estimate;
    const std::vector<const SliceRecord*>& slices;
    const CameraSegment& segment;
    FrameSums& sums;
    uint64_t gathered;
};

void boundsOf(const RTCBoundsFunctionArguments* arguments) {
    const auto& box = static_cast<const SliceGather::Box*>(arguments->geometryUserPtr)[arguments->primID];
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = box.low.x;
    bounds.lower_y = box.low.y;
    bounds.lower_z = box.low.z;
    bounds.upper_x = box.high.x;
    bounds.upper_y = box.high.y;
    bounds.upper_z = box.high.z;
}

void meetBox(const RTCIntersectFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    auto& query = *reinterpret_cast<SliceQuery*>(arguments->context);
    if (query.estimate.add(*query.slices[arguments->primID], query.segment, query.sums)) ++query.gathered;
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
    const TimeGate& gate = sensor.gate;
    for (const SliceRecord& flights : records) {
        const Medium& medium = scene.media[size_t(flights.medium)];
        if (flights.shape == FlightShape::Beam) continue;
        const double left = gate.steadyState ? std::numeric_limits<double>::infinity()
                                             : (gate.end() - flights.time) * double(medium.speedOfLight);
        const float length = float(std::min(left, double(visibleReach(medium))));
        if (!(length > 0.0f)) continue;
        boxes_.push_back(reached(flights, medium, length));
        slices_.push_back(&flights);
    }
    if (!slices_.empty())
        structure_.emplace(RTC_GEOMETRY_TYPE_USER, embree::QueryFilterFlag, [&](RTCGeometry geometry) {
            rtcSetGeometryUserPrimitiveCount(geometry, unsigned(boxes_.size()));
            rtcSetGeometryUserData(geometry, boxes_.data());
            rtcSetGeometryBoundsFunction(geometry, boundsOf, nullptr);
            rtcSetGeometryIntersectFunction(geometry, meetBox);
        });
    if (!beams_.empty()) beamGather_.emplace(scene, sensor, beams_, radius, fewRays);
}

uint64_t SliceGather::gather(const CameraSegment& segment, FrameSums& sums) const {
    const uint64_t gathered = beamGather_ ? beamGather_->gather(segment, sums) : 0;
    if (!structure_) return gathered;
    RTCRayHit ray{};
    ray.ray.org_x = segment.origin.x;
    ray.ray.org_y = segment.origin.y;
    ray.ray.org_z = segment.origin.z;
    ray.ray.dir_x = segment.direction.x;
    ray.ray.dir_y = segment.direction.y;
    ray.ray.dir_z = segment.direction.z;
    ray.ray.tfar = segment.length;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    SliceQuery query{{}, estimate_, slices_, segment, sums, gathered};
    embree::queryAll(structure_->get(), ray, query.context, nullptr);
    return query.gathered;
}

} // namespace tungsten::photon
