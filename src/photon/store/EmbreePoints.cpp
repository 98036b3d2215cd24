#include "photon/store/EmbreePoints.h"

#include <memory>
#include <new>

namespace tungsten::photon {

namespace {

void photonBounds(const RTCBoundsFunctionArguments* arguments) {
    const Vec3f& position = static_cast<const Photon*>(arguments->geometryUserPtr)[arguments->primID].position;
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = bounds.upper_x = position.x;
    bounds.lower_y = bounds.upper_y = position.y;
    bounds.lower_z = bounds.upper_z = position.z;
}

} // namespace

EmbreePoints::EmbreePoints(const std::vector<PointWithRadius>& discs)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    if (discs.empty()) { // Embree has no buffers of nothing
        rtcCommitScene(scene_);
        return;
    }
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_DISC_POINT);
    static_assert(sizeof(PointWithRadius) == 16);
    for (const PointWithRadius& disc : discs) largestRadius_ = std::max(largestRadius_, disc.radius);
    void* buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                           sizeof(PointWithRadius), discs.size());
    if (!buffer) throw std::bad_alloc();
    std::uninitialized_copy(discs.begin(), discs.end(), static_cast<PointWithRadius*>(buffer));
    rtcSetSceneFlags(scene_, embree::QueryFilterFlag);
    commit(geometry);
}

EmbreePoints::EmbreePoints(const std::vector<Photon>& photons)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_COMPACT);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(photons.size()));
    rtcSetGeometryUserData(geometry, const_cast<Photon*>(photons.data()));
    rtcSetGeometryBoundsFunction(geometry, photonBounds, nullptr);
    commit(geometry);
}

void EmbreePoints::commit(RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
}

EmbreePoints::~EmbreePoints() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

} // namespace tungsten::photon
