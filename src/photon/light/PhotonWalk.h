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
    void goOn();
    bool emit();
    // False ends the path.
    bool scatterInMedium(const Medium& medium, float distance);
    bool scatterOnSurface(const SurfaceHit& hit);
    /// What a flight through a medium, up to `reach`, leaves for a primitive, and what the vertex at its end does.
    void depositFlight(DepositList<Photon>& points, const Medium& medium, float reach);
    void depositFlight(DepositList<PhotonBeam>& beams, const Medium& medium, float reach);
    void depositFlight(DepositList<CollapsedFlights>& flights, const Medium& medium, float reach);
    void depositVertex(DepositList<Photon>& points, const Vec3f& position);
    void depositVertex(DepositList<PhotonBeam>& beams, const Vec3f& position);
    void depositVertex(DepositList<CollapsedFlights>& flights, const Vec3f& position);
    /// Slices are made of flights since the last light or surface.
    void beginChain(OneOf<DepositList<Photon>, DepositList<PhotonBeam>> auto&, const Emitter&, float, const Vec2f&) {}
    void beginChain(DepositList<CollapsedFlights>& flights, const Emitter& emitter, float probability,
                    const Vec2f& uPosition);
    void endChain(OneOf<DepositList<Photon>, DepositList<PhotonBeam>> auto&) {}
    void endChain(DepositList<CollapsedFlights>& flights);
    /// The path meets a surface, or ends.
    void leaveRegion();

    LightPath path_;
    const Scene& scene_;
    FlightChain chain_; ///< of the flights since the last light or surface, for slices
};

} // namespace tungsten::photon
