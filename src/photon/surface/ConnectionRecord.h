#pragma once
// What connections bring to visible points.

#include "tungsten/core/Types.h"

#include <cstdint>

namespace tungsten::photon {

/// Light that a connection brought to a visible point.
struct ConnectionRecord {
    uint32_t point; ///< index in the CameraRecord
    int32_t frame;
    float offCentre; ///< of its arrival in the frame: -1 at the start, 1 at the end
    Vec3f from;      ///< unit direction it came from
    Rgb light;       ///< of one path: times BSDF and cosine, radiance times the frame's width
};

} // namespace tungsten::photon
