#pragma once
// What a camera subpath looks volumes up along, and everything that Embree holds about it.

#include "tungsten/core/Types.h"
#include "tungsten/geometry/Embree.h"

#include <vector>

namespace tungsten::photon {

/// A camera segment in one medium.
struct CameraSegment {
    Vec3f origin, direction;
    float length; ///< may be infinite
    double time;  ///< of the camera path up to the origin
    double inverseSpeed;
    int interactions; ///< of the camera path up to the origin
    int medium;
};

/// Sums of contributions per frame; doubles, so that the order of the sum shows only beyond the seventh digit.
using FrameSums = std::vector<Vec3d>;

/// Calls evaluate(query, index) for every disc or ribbon of at most `radius` that may be near the segment; the hits are
/// a superset, for evaluate() to test exactly. `query.context` is the query's first member, so that Embree's address of
/// it is the query's.
template <auto Evaluate, typename Query>
void queryAbout(RTCScene scene, const CameraSegment& segment, float radius, Query& query) {
    // Embree skips what holds or nearly touches the ray's origin: start two radii behind it.
    const float margin = 2.0001f * radius;
    RTCRayHit ray{};
    ray.ray.org_x = segment.origin.x - segment.direction.x * margin;
    ray.ray.org_y = segment.origin.y - segment.direction.y * margin;
    ray.ray.org_z = segment.origin.z - segment.direction.z * margin;
    ray.ray.dir_x = segment.direction.x;
    ray.ray.dir_y = segment.direction.y;
    ray.ray.dir_z = segment.direction.z;
    ray.ray.tnear = 0.0f;
    ray.ray.tfar = segment.length + 2.0f * margin;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    // Rejects every hit, so that traversal goes on.
    const RTCFilterFunctionN filter = [](const RTCFilterFunctionNArguments* arguments) {
        Evaluate(*reinterpret_cast<Query*>(arguments->context), RTCHitN_primID(arguments->hit, 1, 0));
        arguments->valid[0] = 0;
    };
    embree::queryAll(scene, ray, query.context, filter);
}

} // namespace tungsten::photon
