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

} // namespace tungsten::photon
