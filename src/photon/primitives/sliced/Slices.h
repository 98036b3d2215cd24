#pragma once
// Planes, volumes, balls and hypervolumes: flights that are integrated over instead of blurred by a kernel. One type of
// the set for all of them, since each brings others for the paths that it cannot make.

#include "photon/primitives/Primitive.h"
#include "photon/primitives/sliced/SliceRecord.h"
#include "photon/store/ArrivalCulling.h"

#include <optional>

namespace tungsten::photon {

/// Which primitive makes which paths, by the chain index m: medium scatterings since the last surface or light, the one
/// on the camera ray included (docs/photon-primitives.md, section 3).
enum class SliceKind { Planes, Volumes, Balls, VolumesBalls, MisVolumesBalls, Hypervolumes };

struct SliceName {
    const char* type; ///< of volume_photon_type
    SliceKind kind;
    bool steadyState; ///< also without a time gate
};
inline constexpr std::array SliceNames{SliceName{"planes", SliceKind::Planes, true},
                                       SliceName{"volumes", SliceKind::Volumes, true},
                                       SliceName{"balls", SliceKind::Balls, false},
                                       SliceName{"volumes_balls", SliceKind::VolumesBalls, false},
                                       SliceName{"mis_volumes_balls", SliceKind::MisVolumesBalls, false},
                                       SliceName{"hypervolumes", SliceKind::Hypervolumes, false}};

constexpr const SliceName& sliceName(SliceKind kind) {
    return SliceNames[size_t(kind)];
}

/// Every class m has one shape, but for those that balls and volumes share.
struct SliceClasses {
    enum class Bases : uint8_t { None, First, All };

    bool lights = false; ///< m = 1: balls on lights that shine in more than one direction
    bool beams = false;  ///< m = 1 after a surface or a laser: photon beams
    /// Which chain indices the records of k = 2 to 4 flights make: None, First: m = k, All: m >= k.
    std::array<Bases, 5> flights{};
    int firstBall = 0, lastBall = -1; ///< medium vertices of the chain with a ball: m = vertex + 1
    float share = 1.0f;        ///< of what is not a beam that is left, at random; its power makes up for the rest
    float sharedShare = 1.0f;  ///< likewise, of paths that balls and volumes both make
    bool shared = false;       ///< m >= 3: balls and volumes together
    bool shortFlights = false; ///< flights end at random lengths
    /// Last flights of what single balls make at a delta gate: beams up to this length, balls beyond it; after surfaces
    /// that scatter evenly too. 0: balls alone, and beams alone after surfaces.
    float shortBeams = 0.0f;

    [[nodiscard]] float shareOf(const SliceRecord& record) const { return record.shared ? sharedShare : share; }
    /// A vertex of a chain has a ball that volumes do not share.
    [[nodiscard]] bool hasSingleBall(int vertex) const {
        return vertex >= firstBall && vertex <= lastBall && !(shared && vertex >= 2);
    }
    /// `lowOrders`: with m = 1. `onlyShared`: m >= 3 alone, which balls and volumes both make.
    static SliceClasses of(SliceKind kind, bool steadyState, bool lowOrders, bool onlyShared);
};

class SliceGather;

struct Slices {
    using Record = SliceRecord;
    using Gather = SliceGather;
    static constexpr size_t PartsAtSurfaces = 0; ///< that kernels near them become: slices have no kernels
    static constexpr bool AtVertices = false;
    static constexpr bool ManyFrames = true;
    static constexpr bool NeedsPlace = false;
    static constexpr bool LimitsRecords = true;
    static constexpr const char* Effect = "sliced primitives";
    static constexpr const char* Reason = "a medium scatters, volume_photon_type asks for it";
    static constexpr const char* Stored = "sliced primitives"; ///< counters
    static constexpr const char* Gathered = "gathered slices";

    SliceKind kind = SliceKind::Planes;
    SliceClasses classes{};

    static float reach(const KernelSettings&) { return Infinity; }
    /// Which classes they make, and the radius of beams where there are any among them.
    void read(const ObjectReader& block, const Scene& scene, PhotonSettings& settings);
    static std::string guidanceObstacle(const Scene& scene, bool speedsDiffer);
    /// Any camera.
    [[nodiscard]] bool splats(bool /*straightRays*/, bool oneTime) const { return !classes.shortFlights && oneTime; }
    static bool radiiFollowRecords(const KernelSettings&) { return false; }
    /// Narrows as the temporal kernel and the beams' radius do. The variance of beams grows as the inverse of both:
    /// time is best spent in proportion to the square roots of the variances.
    void narrow(float factor) {
        classes.shortBeams *= factor;
        if (!classes.beams || classes.share >= 1.0f) return;
        classes.share *= factor;
        classes.sharedShare *= factor;
    }
    static double kernelWidth(const KernelSettings& settings, bool deltaGate, uint32_t step);
    static Radii radii(const KernelSettings& settings, bool deltaGate, const std::vector<SliceRecord>& records,
                       uint32_t step, const ProgressToken& watch);
    /// Slices have no kernels.
    static NearSurfaces nearSurfaces(const KernelSettings&, const Scene& scene) { return {scene, Infinity, 1.0f}; }
    static void endAtSurfaces(const KernelEnds&, const std::vector<SliceRecord>&, const Radii&) {}
    /// All.
    static std::optional<Selection<SliceRecord>> straight(const Scene&, const ArrivalCulling&,
                                                          const std::vector<SliceRecord>&, const Radii&) {
        return std::nullopt;
    }
    static double redirectedShare(const std::vector<SliceRecord>&, const Radii&) { return 1.0; }
    static uint64_t splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                          const Selection<SliceRecord>& slices, double scale, Film& film, const ProgressToken& watch);
};

/// Light that is seen scattering once after a surface or a light of a single direction: slices leave it to beams.
bool slicesNeedBeams(const Scene& scene, const SliceClasses& classes);

/// |g| of the media that scatter.
float largestPeak(const Scene& scene);

} // namespace tungsten::photon
