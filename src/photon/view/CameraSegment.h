#pragma once
// What a camera subpath looks volumes up along.

#include "tungsten/core/Types.h"

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

} // namespace tungsten::photon
