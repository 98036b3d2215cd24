#pragma once
// Straight connections between a path's vertices and emitters.

#include "tungsten/scene/Interaction.h"

namespace tungsten::path {

/// As traceVisibility does. Without forward boundaries in the scene every surface is opaque: one ray, one region.
inline Visibility traceConnection(const Scene& scene, bool forwardBoundaries, const Ray& ray, float distance,
                                  const Region& region, uint64_t& rays) {
    if (forwardBoundaries) return traceVisibility(scene, ray, distance, region, rays);
    ++rays;
    if (scene.geometry->occluded(ray)) return {};
    const Medium* medium = scene.medium(region);
    Visibility visibility;
    visibility.transmittance = medium ? medium->transmittance(distance) : Rgb(1.0f);
    visibility.time = double(distance) / double(region.speed);
    return visibility;
}

} // namespace tungsten::path
