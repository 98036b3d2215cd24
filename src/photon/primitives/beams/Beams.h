#pragma once
// Photon beams: every flight through a medium, gathered with a one-dimensional kernel about camera rays.

#include "photon/primitives/Primitive.h"
#include "photon/store/ArrivalCulling.h"
#include "photon/store/Store.h"

namespace tungsten::photon {

/// A flight from a light, a medium vertex or a surface. It stands for every collision along its stored part: the power
/// that collides per unit of length at s is power sigma_s T(s), with s and T measured from the base (long beams,
/// docs/photon-primitives.md, section 2.2).
struct PhotonBeam {
    double time; ///< at the base, since the clock's zero
    Vec3f base;
    Vec3f direction;
    Rgb power;          ///< leaving the base, of one path; the store's `scale` still divides it by the number of paths
    float tStart, tEnd; ///< stored part, distances from the base
    uint16_t bounce;    ///< interactions from the light up to and including the base
    int16_t medium;     ///< index of the medium the flight crosses
};
static_assert(sizeof(PhotonBeam) == 56, "millions are stored: no padding");

/// Beyond it nothing of a flight shows in a float.
float visibleReach(const Medium& medium);

/// The part of a flight that camera subpaths can see inside the gate, if there is one. `flight` runs from tStart to
/// tEnd, the next surface (Infinity if there is none).
std::optional<PhotonBeam> clippedBeam(const ArrivalCulling& culling, const Medium& medium, PhotonBeam flight);

/// The part of a beam that camera subpaths without mirror or refraction can see inside the gate, if there is one; needs
/// culling.straightTimesKnown().
std::optional<PhotonBeam> straightPart(const Scene& scene, const ArrivalCulling& culling, PhotonBeam beam);

class BeamGather;

/// Photon beams as a volume primitive; Points.h documents the members. All beams have one radius.
struct Beams {
    using Record = PhotonBeam;
    using Gather = BeamGather;
    static constexpr const char* Type = "beams";
    static constexpr size_t PartsAtSurfaces = 3; ///< that kernels near them become: what is clear, and either end
    static constexpr bool AtVertices = false;
    static constexpr bool ManyFrames = false;
    static constexpr bool NeedsPlace = true;
    static constexpr bool LimitsRecords = false;
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
    /// Cuts beams near surfaces, which end their ribbons there (docs/photon-primitives.md, section 2.8).
    ///
    /// Each beam becomes parts without a surface within the radius, which are as before, and parts of at most
    /// tuning::NearPartInRadii, which know the planes of the surfaces about their middles: what of the ribbon lies
    /// before them is the kernel there. These are narrower, tuning::WidthAtSurfaces, and no wider than the room between
    /// two surfaces. What curved surfaces and corners still cut off is made up for on average. Beams out of view are
    /// left out.
    static void endAtSurfaces(const KernelEnds& ends, std::vector<PhotonBeam>& beams, Radii& radii);
    static Selection<PhotonBeam> straight(const Scene& scene, const ArrivalCulling& culling,
                                          const std::vector<PhotonBeam>& beams, const Radii& radii);
    static double redirectedShare(const std::vector<PhotonBeam>& beams, const Radii& radii);
    /// Adds what BeamGather would gather along the straight rays of each record to the pass image, times `scale`. Each
    /// beam visits the pixels that its ribbon covers. Returns the number of beams gathered, one per pixel and beam.
    /// `sensor` has the pass's gate.
    static uint64_t splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                          const Selection<PhotonBeam>& beams, double scale, Film& film,
                          const ProgressToken& watch = {});
};

} // namespace tungsten::photon
