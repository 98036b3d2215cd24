#pragma once
// Straight connections between a path's vertices and emitters.

#include "transport/Connection.h"

#include "tungsten/scene/LightChoice.h"

namespace tungsten::path {

inline Visibility traceConnection(const Scene& scene, bool forwardBoundaries, const Ray& ray, float distance,
                                  const Region& region, uint64_t& rays) {
    return transport::Connector(scene, forwardBoundaries).visibility(ray, distance, region, rays);
}

} // namespace tungsten::path
