#include "photon/primitives/sliced/EmbreeSlices.h"

namespace tungsten::photon {

namespace {

/// What the callback sees: its first member is the query's context, so that Embree's address of it is the query's.
struct SliceQuery {
    embree::Context context;
    EmbreeSlices::Meet meet;
    void* user;
};

void boundsOf(const RTCBoundsFunctionArguments* arguments) {
    const auto& box = static_cast<const EmbreeSlices::Box*>(arguments->geometryUserPtr)[arguments->primID];
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
    const auto& query = *reinterpret_cast<const SliceQuery*>(arguments->context);
    query.meet(query.user, arguments->primID);
}

} // namespace

EmbreeSlices::EmbreeSlices(std::vector<Box> boxes)
    : boxes_(std::move(boxes)), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(boxes_.size()));
    rtcSetGeometryUserData(geometry, boxes_.data());
    rtcSetGeometryBoundsFunction(geometry, boundsOf, nullptr);
    rtcSetGeometryIntersectFunction(geometry, meetBox);
    rtcSetSceneFlags(scene_, embree::QueryFilterFlag);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
}

EmbreeSlices::~EmbreeSlices() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void EmbreeSlices::query(const CameraSegment& segment, Meet meet, void* user) const {
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
    SliceQuery query{{}, meet, user};
    embree::queryAll(scene_, ray, query.context, nullptr);
}

} // namespace tungsten::photon
