#pragma once
// The volume primitive of `volume_photon_type: auto`: a rule from measurements (docs/photon-primitives.md,
// section 3.2).

#include "photon/primitives/VolumePrimitive.h"

#include "tungsten/scene/Scene.h"

#include <string>

namespace tungsten::photon {

struct AutoPrimitive {
    VolumePrimitive primitive;
    std::string reason;

    /// `hasRadius`: the scene gives one, which beams need.
    static AutoPrimitive of(const Scene& scene, bool hasRadius);
};

/// Light that is seen scattering once after a surface or a light of a single direction: slices leave it to beams.
bool slicesNeedBeams(const Scene& scene, const SliceClasses& classes);

/// |g| of the media that scatter.
float largestPeak(const Scene& scene);

} // namespace tungsten::photon
