#pragma once
// Straight connections between a path's vertices and emitters.

#include "tungsten/scene/Interaction.h"
#include "tungsten/scene/LightChoice.h"

namespace tungsten::path {

/// A connection that starts in `region`; its ray's tMin is above 0 when it leaves a surface, `toSurface` says whether
/// it ends on one. Without forward boundaries in the scene every surface is opaque: one ray, one region.
inline Visibility traceConnection(const Scene& scene, bool forwardBoundaries, const Ray& ray, float distance,
                                  bool toSurface, const Region& region, uint64_t& rays) {
    if (forwardBoundaries)
        return traceVisibility(scene, ray.origin, ray.tMin > 0.0f, ray.direction, distance, toSurface, region, rays);
    ++rays;
    if (scene.geometry->occluded(
            {ray.origin, ray.direction, ray.tMin, toSurface ? distance - scene.rayEpsilon : distance}))
        return {};
    const Medium* medium = scene.medium(region);
    Visibility visibility;
    visibility.transmittance = medium ? medium->transmittance(distance) : Rgb(1.0f);
    visibility.time = double(distance) / double(region.speed);
    return visibility;
}

} // namespace tungsten::path
