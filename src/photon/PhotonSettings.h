#pragma once
// Settings of the photon-map integrators' block (docs/scene-format.md, section 10.2).

#include "photon/primitives/VolumePrimitive.h"

#include "transport/Policy.h"

#include "tungsten/reader/ObjectReader.h"
#include "tungsten/scene/Scene.h"

#include <string>

namespace tungsten::photon {

/// The radius of volume kernels where they need one and the scene names none.
///
/// A hundredth of what the image spans at the depth that it shows: where most of its rays meet a surface, or three mean
/// free paths away in a medium about the camera, if that is nearer. Not longer than light travels in a frame, which
/// kernels blur by their radius, unless that is less than a tenth of it.
struct DefaultRadius {
    float radius = 0.0f; ///< length, above 0
    std::string reason;

    static DefaultRadius of(const Scene& scene);
};

struct PhotonSettings : KernelSettings {
    /// Where the scene leaves the radius open, a primitive that needs a volumeRadius gets one that suits it.
    void requireRadius(const ObjectReader& block, const Scene& scene);
    /// With counts for a part of a pass (PassInfo::share).
    [[nodiscard]] PhotonSettings ofShare(double share) const;

    VolumePrimitive primitive;                 ///< the first of the alternatives until one has been chosen
    std::vector<VolumePrimitive> alternatives; ///< volume_photon_type auto: what a pilot chooses from
    std::string primitiveReason;               ///< of its choice, where a pilot has made it
    uint64_t photonCount = 1000000;            ///< light paths per pass, and capacity of the surface store
    uint64_t volumePhotonCount = 1000000;      ///< capacity of the volume store, points or beams
    uint32_t gatherCount = 20;      ///< nearest surface photons, the last of which gives the radius; at least 2
    std::string radiusReason;       ///< of volumeRadius, where the scene leaves it open
    float gatherRadius = 1e30f;     ///< largest distance of a gathered surface photon
    double temporalRadius = 0.0;    ///< half-width of a delta gate's temporal kernel in the first pass
    bool lowOrderScattering = true; ///< false: no photon on the first medium vertex after a light or surface, and
                                    ///< no beam from a light or surface
    bool excludeNonMis = false;     ///< slices: classes alone that volumes and balls both make
    bool shortFlights = false;      ///< slices: flights end at random lengths
    bool includeSurfaces = true;    ///< false: no surface photons, no visible emission
    bool progressive = true;
    transport::Policy policy; ///< how light paths are guided

    /// From camera rays that a record of the volume primitive can show on.
    [[nodiscard]] float volumeReach() const {
        return std::visit([&](const auto& p) { return p.reach(*this); }, primitive);
    }
};

/// Reads the block; problems and warnings go to the reader's diagnostics.
PhotonSettings readPhotonSettings(const ObjectReader& block, const Scene& scene, bool progressive);

} // namespace tungsten::photon
