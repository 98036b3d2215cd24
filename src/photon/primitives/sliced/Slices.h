#pragma once
// Planes, volumes, balls and hypervolumes: flights that are integrated over instead of blurred by a kernel. One type of
// the set for all of them, since each brings others for the paths that it cannot make.

#include "photon/primitives/Primitive.h"
#include "photon/primitives/sliced/SliceKind.h"
#include "photon/store/ArrivalCulling.h"

#include <optional>

namespace tungsten::photon {

class SliceGather;

struct Slices {
    using Record = SliceRecord;
    using Gather = SliceGather;
    static constexpr size_t PartsAtSurfaces = 0; ///< that kernels near them become: slices have no kernels
    static constexpr bool AtVertices = false;
    static constexpr bool ManyFrames = true;
    static constexpr bool NeedsPlace = false;
    static constexpr bool LimitsRecords = true;
    static constexpr bool SplatsOften = false;
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
