#pragma once
// One light path and what it deposits.

#include "photon/PhotonSettings.h"
#include "photon/light/Deposits.h"
#include "photon/primitives/sliced/FlightChain.h"
#include "photon/store/ArrivalCulling.h"

#include "tungsten/scene/Interaction.h"

#include <span>

namespace tungsten::photon {

struct WalkCounters {
    uint64_t rays = 0, controlVertices = 0;
    /// Photons that reached the test of arrival on their way to the volume store, and those that passed it.
    uint64_t volumeDeposits = 0, countingDeposits = 0;
    uint64_t nonFinite = 0; ///< powers: nothing was stored
};

/// What every walk of a pass shares.
struct WalkContext {
    const Scene& scene;
    const PhotonSettings& settings;
    const ArrivalCulling& arrival;
    std::span<const ArrivalCulling> frameArrivals; ///< for paths that aim at single frames
    float frameShift; ///< of the order of frames: over passes, each is aimed at equally often
    const Distribution1D& emitters;
    bool storeSurface, storeVolume;
    bool connects = false; ///< to surfaces: SurfaceConnections
    /// Photons without power where connections bring the light: gathers of the nearest take their radius from how dense
    /// photons are, not from how dense those few are that bring what connections cannot.
    bool densityPhotons = false;
    bool glossySensorPaths = false; ///< SensorPathRules::glossy
};

class PhotonWalk {
  public:
    PhotonWalk(const WalkContext& context, Sampler sampler, Deposits& deposits, WalkCounters& counters)
        : context_(context), scene_(context.scene), arrival_(&context.arrival), sampler_(sampler), deposits_(deposits),
          counters_(counters) {}

    void run();

  protected:
    void goOn();
    bool emit();
    /// By the emitter's own distribution; `probability` is that of its choice.
    bool emitFrom(const Emitter& emitter, float probability);
    /// False ends the path.
    bool scatterInMedium(const Medium& medium, float distance);
    bool scatterOnSurface(const SurfaceHit& hit) { return arriveOnSurface(hit) && leaveSurface(); }
    /// What a flight through a medium, up to `reach`, leaves for a primitive, and what the vertex at its end does.
    void depositFlight(DepositList<Photon>& points, const Medium& medium, float reach);
    void depositFlight(DepositList<PhotonBeam>& beams, const Medium& medium, float reach);
    void depositFlight(DepositList<CollapsedFlights>& flights, const Medium& medium, float reach);
    void depositVertex(DepositList<Photon>& points, const Vec3f& position);
    void depositVertex(DepositList<PhotonBeam>& beams, const Vec3f& position);
    void depositVertex(DepositList<CollapsedFlights>& flights, const Vec3f& position);
    /// The path leaves the medium, or ends.
    void endChain();
    /// Time, bounce and deposit; surface_ is set.
    bool arriveOnSurface(const SurfaceHit& hit);
    bool leaveSurface();
    /// Whether sensor paths along its glossy lobes find the light that arrives on surface_.
    [[nodiscard]] bool foundBySensorPaths() const;
    /// False, and counted if it is not finite, for a power that leaves nothing.
    bool bears(const Rgb& power);
    /// False if it cannot be gathered.
    bool deposit(DepositList<Photon>& list, const Vec3f& position, const Rgb& power, int medium);

    const WalkContext& context_;
    const Scene& scene_;
    const ArrivalCulling* arrival_;
    Sampler sampler_;
    Deposits& deposits_;
    WalkCounters& counters_;

    FlightChain chain_;          ///< of the flights since the last light or surface, for slices
    SurfaceInteraction surface_; ///< where the path is, between arriving and leaving
    Ray ray_;
    Region region_;
    Rgb power_{0.0f};
    double time_ = 0.0;
    int bounce_ = 0;
    int flights_ = 0;           ///< distances sampled since the last surface
    int consecutiveMedium_ = 0; ///< medium vertices since the last light or surface
    bool connectable_ = false;  ///< the last vertex has no single direction and lies in this region: it connects
    bool fromLight_ = true;     ///< nothing has scattered since the light but mirrors and refraction
};

} // namespace tungsten::photon
