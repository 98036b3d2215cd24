#pragma once
// One light path and what it deposits.

#include "photon/ArrivalTest.h"
#include "photon/PhotonBeam.h"
#include "photon/PhotonSettings.h"

#include "tungsten/scene/Interaction.h"

namespace tungsten::photon {

/// Photons of consecutive paths; pathEnds[i] is where path i's end.
struct DepositList {
    std::vector<Photon> photons;
    std::vector<uint32_t> pathEnds;
    void endPath() { pathEnds.push_back(uint32_t(photons.size())); }
};

struct WalkCounters {
    uint64_t rays = 0;
};

/// What every walk of a pass shares.
struct WalkContext {
    const Scene& scene;
    const PhotonSettings& settings;
    const ArrivalTest& arrival;
    const Distribution1D& emitters;
    bool storeSurface, storeVolume, storeBeams;
};

class PhotonWalk {
  public:
    PhotonWalk(const WalkContext& context, Sampler sampler, DepositList& surface, DepositList& volume, BeamList& beams,
               WalkCounters& counters)
        : context_(context), scene_(context.scene), sampler_(sampler), surface_(surface), volume_(volume),
          beams_(beams), counters_(counters) {}

    void run();

  private:
    bool emit();
    /// False ends the path.
    bool scatterInMedium(const Medium& medium, float distance);
    bool scatterOnSurface(const SurfaceHit& hit);
    /// The flight ahead, up to `reach`.
    void depositBeam(const Medium& medium, float reach);
    void deposit(DepositList& list, const Vec3f& position, const Rgb& power, int medium);

    const WalkContext& context_;
    const Scene& scene_;
    Sampler sampler_;
    DepositList& surface_;
    DepositList& volume_;
    BeamList& beams_;
    WalkCounters& counters_;

    Ray ray_;
    Region region_;
    Rgb power_{0.0f};
    double time_ = 0.0;
    int bounce_ = 0;
    int flights_ = 0;           ///< distances sampled since the last surface
    int consecutiveMedium_ = 0; ///< medium vertices since the last light or surface
};

} // namespace tungsten::photon
