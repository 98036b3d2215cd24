#pragma once
// Plain light paths: free flights and directions by the scene's own distributions.

#include "photon/light/LightPath.h"

namespace tungsten::photon {

class PhotonWalk {
  public:
    PhotonWalk(const WalkContext& context, const Sampler& sampler, Deposits& deposits, WalkCounters& counters)
        : path_(context, sampler, deposits, counters), scene_(context.scene) {}

    void run();

  private:
    bool emit();
    // False ends the path.
    bool scatterInMedium(const Medium& medium, float distance);
    bool scatterOnSurface(const SurfaceHit& hit) { return path_.arriveOnSurface(hit) && path_.leaveSurface(); }
    /// What a flight through a medium, up to `reach`, leaves for a primitive, and what the vertex at its end does.
    void depositFlight(DepositList<Photon>& points, const Medium& medium, float reach);
    void depositFlight(DepositList<PhotonBeam>& beams, const Medium& medium, float reach);
    void depositVertex(DepositList<Photon>& points, const Vec3f& position);
    void depositVertex(DepositList<PhotonBeam>& beams, const Vec3f& position);

    LightPath path_;
    const Scene& scene_;
};

} // namespace tungsten::photon
