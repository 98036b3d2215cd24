#pragma once
// The volume primitive of `volume_photon_type: auto`, measured: a few passes of every one that the scene allows, before
// the first pass of the render (docs/photon-primitives.md, section 3.2).

#include "photon/PhotonSettings.h"

#include "tungsten/integrator/Integrator.h"

#include <memory>
#include <string>

namespace tungsten::photon {

struct MeasuredPrimitive {
    VolumePrimitive primitive;
    std::string reason;
    uint64_t passes = 0;
};

/// The one of settings.alternatives whose passes have the least variance times cost. Random numbers are the pilot's
/// own and costs are counted, not timed: every part of a render, on every machine, chooses alike. `facts`: the plan of
/// the render, complete. Polls `watch`.
MeasuredPrimitive measurePrimitives(const std::shared_ptr<const Scene>& scene, const PhotonSettings& settings,
                                    const SceneFacts& facts, const ProgressToken& watch);

/// What `--explain` says before the pilot has run; `alternatives` has more than one.
std::string primitivesToMeasure(const std::vector<VolumePrimitive>& alternatives);

} // namespace tungsten::photon
