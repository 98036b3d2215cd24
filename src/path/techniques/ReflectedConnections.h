#pragma once
// Light that a glossy surface has reflected (ReflectedLight.h), connected to vertices of the walk.

#include "path/GuidedPath.h"
#include "path/techniques/ReflectedLight.h"

namespace tungsten::path {

struct ReflectedConnections {
    /// From the ray's origin: on `surface`, or in the medium if there is none.
    static void connect(GuidedPath& path, const SurfaceInteraction* surface, const ReflectedLightCache& cache);
    /// Of the reflected light that one vertex before was connected to, at the ray's origin and at a light vertex of
    /// density `areaPdf` at distance `flight` in direction `direction` from `glossy`, over the walk's density at the
    /// ray's origin; 0 if there was none.
    [[nodiscard]] static float density(const GuidedPath& path, const SurfaceInteraction& glossy, const Vec3f& direction,
                                       float flight, const Vec3f& toLight, float areaPdf);
};

} // namespace tungsten::path
