#pragma once
// Photon beams: every flight through a medium, gathered with a one-dimensional kernel about camera rays.

#include "photon/primitives/Primitive.h"
#include "photon/primitives/beams/PhotonBeam.h"

namespace tungsten::photon {

class BeamGather;

/// Photon beams as a volume primitive; the concept in Primitive.h documents the members. All beams have one radius.
struct Beams {
    using Record = PhotonBeam;
    using Gather = BeamGather;
    static constexpr const char* Type = "beams";
    static constexpr size_t PartsAtSurfaces = 3; ///< that kernels near them become: what is clear, and either end
    static constexpr bool AtVertices = false;
    static constexpr bool ManyFrames = false;
    static constexpr bool NeedsPlace = true;
    static constexpr bool LimitsRecords = false;
    static constexpr bool SplatsOften = true;
    static constexpr const char* Effect = "photon beams";
    static constexpr const char* Reason = "a medium scatters, volume_photon_type is beams";
    static constexpr const char* Stored = "photon beams";
    static constexpr const char* Gathered = "gathered beams";

    static float reach(const KernelSettings& settings);
    static void read(const ObjectReader& block, const Scene& scene, PhotonSettings& settings);
    static std::string guidanceObstacle(const Scene&, bool /*speedsDiffer*/) { return {}; }
    static bool splats(bool straightRays, bool /*oneTime*/) { return straightRays; }
    static bool radiiFollowRecords(const KernelSettings&) { return false; }
    static void narrow(float /*factor*/) {}
    static double kernelWidth(const KernelSettings& settings, bool deltaGate, uint32_t step);
    static Radii radii(const KernelSettings& settings, bool deltaGate, const std::vector<PhotonBeam>& beams,
                       uint32_t step, const ProgressToken& watch);
    static NearSurfaces nearSurfaces(const KernelSettings& settings, const Scene& scene);
    static void endAtSurfaces(const KernelEnds& ends, std::vector<PhotonBeam>& beams, Radii& radii);
    static Selection<PhotonBeam> straight(const Scene& scene, const ArrivalCulling& culling,
                                          const std::vector<PhotonBeam>& beams, const Radii& radii);
    static double redirectedShare(const std::vector<PhotonBeam>& beams, const Radii& radii);
    static uint64_t splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                          const Selection<PhotonBeam>& beams, double scale, Film& film, const ProgressToken& watch);
};

} // namespace tungsten::photon
