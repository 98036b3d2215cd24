#include "photon/EmbreePoints.h"

#include <cstring>
#include <new>

namespace tungsten::photon {

namespace {

void pointBounds(const RTCBoundsFunctionArguments* arguments) {
    const auto& point = static_cast<const PointWithRadius*>(arguments->geometryUserPtr)[arguments->primID];
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = bounds.upper_x = point.position.x;
    bounds.lower_y = bounds.upper_y = point.position.y;
    bounds.lower_z = bounds.upper_z = point.position.z;
}

RTCGeometry discs(RTCDevice device, const std::vector<PointWithRadius>& points) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_DISC_POINT);
    static_assert(sizeof(PointWithRadius) == 16);
    void* buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(PointWithRadius),
                                           points.size());
    if (!buffer) throw std::bad_alloc();
    std::memcpy(buffer, points.data(), points.size() * sizeof(PointWithRadius));
    return geometry;
}

RTCGeometry boxes(RTCDevice device, std::vector<PointWithRadius>& points) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(points.size()));
    rtcSetGeometryUserData(geometry, points.data());
    rtcSetGeometryBoundsFunction(geometry, pointBounds, nullptr);
    return geometry;
}

} // namespace

EmbreePoints::EmbreePoints(std::vector<PointWithRadius> points, PointUse use)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    for (const PointWithRadius& point : points) largestRadius_ = std::max(largestRadius_, point.radius);
    if (use == PointUse::PointQueries) points_ = std::move(points);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    if (!points.empty() || !points_.empty()) {
        RTCGeometry geometry = use == PointUse::Rays ? discs(device_, points) : boxes(device_, points_);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_);
}

EmbreePoints::~EmbreePoints() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

} // namespace tungsten::photon
