#pragma once
// Photon points: a deposit where a light path scatters, gathered with a two-dimensional kernel about camera rays.

#include "photon/primitives/Primitive.h"
#include "photon/store/ArrivalCulling.h"
#include "photon/store/Store.h"

namespace tungsten::photon {

class PointGather;

struct Points {
    using Record = Photon;
    using Gather = PointGather;
    static constexpr const char* Type = "points"; ///< volume_photon_type
    static constexpr size_t PartsAtSurfaces = 2;  ///< that kernels near them become: a record and its image
    static constexpr bool AtVertices = true;      ///< records are vertices, so that control vertices can be
    static constexpr bool ManyFrames = false;     ///< a record shows in one frame, or a few
    static constexpr bool NeedsPlace = true;      ///< to aim guided paths at, also where the camera's time is left out
    static constexpr bool LimitsRecords = false;  ///< guided paths thin them by how many they expect (RecordBudget)
    static constexpr const char* Effect = "volume photon points";
    static constexpr const char* Reason = "a medium scatters";
    static constexpr const char* Stored = "stored volume photons"; ///< counters
    static constexpr const char* Gathered = "gathered photons";

    /// From camera rays that a record can show on. Any, where radii follow the density: they are known when the store
    /// is full, and what is stored makes the density.
    static float reach(const KernelSettings& settings);
    /// Fields that it alone has a use for, when all others are read.
    static void read(const ObjectReader& block, const Scene& scene, PhotonSettings& settings);
    /// Why guided light paths are no use to it in this scene; empty where they are.
    static std::string guidanceObstacle(const Scene&, bool /*speedsDiffer*/) { return {}; }
    /// Along camera rays that are straight, at one speed and from one point, or at one speed or where speeds do not
    /// matter.
    static bool splats(bool straightRays, bool /*oneTime*/) { return straightRays; }
    /// Radii follow the records' density: as the inverse cube root of the number of light paths.
    static bool radiiFollowRecords(const KernelSettings& settings) { return !settings.fixedVolumeRadius; }
    /// In a pass whose delta gate's kernel is so much narrower than the first one's.
    static void narrow(float /*factor*/) {}
    /// Kernel width of a pass, where that of the first is 1.
    static double kernelWidth(const KernelSettings& settings, bool deltaGate, uint32_t step);
    static Radii radii(const KernelSettings& settings, bool deltaGate, const std::vector<Photon>& photons,
                       uint32_t step, const ProgressToken& watch);
    /// For endAtSurfaces().
    static NearSurfaces nearSurfaces(const KernelSettings& settings, const Scene& scene);
    /// Records and radii become those of kernels that end at surfaces (docs/photon-primitives.md, section 2.8).
    ///
    /// Ends kernels at the plane through the nearest point of a surface, and adds their mirror images behind it, which
    /// end there, too: what one loses beyond the plane the other brings before it, for rays of any direction. Where a
    /// second surface is as near on the other side, the radius ends there. What curved surfaces and corners still cut
    /// off is made up for on average over directions. Records that no surface is near to, or that are out of view, stay
    /// as they are.
    static void endAtSurfaces(const KernelEnds& ends, std::vector<Photon>& photons, Radii& radii);
    /// What straight camera subpaths see inside the gate; needs culling.straightTimesKnown().
    static Selection<Photon> straight(const Scene& scene, const ArrivalCulling& culling,
                                      const std::vector<Photon>& photons, const Radii& radii);
    /// The part that redirected rays need where straight ones have theirs splatted (ExpectedHits).
    static double redirectedShare(const std::vector<Photon>& photons, const Radii& radii);
    /// Adds what PointGather would gather along the straight rays of each record to the pass image, times `scale`. Each
    /// photon visits the pixels that its kernel covers: an order of magnitude cheaper than a hierarchy over the photons
    /// and a traversal per ray (benchmarks/micro, gather). Returns the number of photons gathered, one per pixel and
    /// photon. `sensor` has the pass's gate.
    static uint64_t splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                          const Selection<Photon>& photons, double scale, Film& film, const ProgressToken& watch = {});
};

} // namespace tungsten::photon
