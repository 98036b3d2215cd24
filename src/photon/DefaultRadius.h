#pragma once
// The radius of volume kernels where they need one and the scene names none.

#include "tungsten/scene/Scene.h"

#include <string>

namespace tungsten::photon {

/// A hundredth of what the image spans at the depth that it shows: where most of its rays meet a surface, or three mean
/// free paths away in a medium about the camera, if that is nearer. Not longer than light travels in a frame, which
/// kernels blur by their radius, unless that is less than a tenth of it.
struct DefaultRadius {
    float radius = 0.0f; ///< length, above 0
    std::string reason;

    static DefaultRadius of(const Scene& scene);
};

} // namespace tungsten::photon
