#pragma once
// Where a light path has got to, and what it deposits: what every walk from a light keeps.

#include "photon/PhotonSettings.h"
#include "photon/light/Deposits.h"
#include "photon/light/FirstUsefulness.h"
#include "photon/primitives/sliced/FlightChain.h"
#include "photon/primitives/sliced/RecordCounts.h"
#include "photon/store/ArrivalCulling.h"
#include "transport/StepCounters.h"

#include "tungsten/scene/Interaction.h"

#include <span>

namespace tungsten::photon {

struct WalkCounters : transport::StepCounters {
    uint64_t controlVertices = 0;
    /// Photons that reached the test of arrival on their way to the volume store, and those that passed it.
    uint64_t volumeDeposits = 0, countingDeposits = 0;
    uint64_t nonFinite = 0; ///< powers: nothing was stored
};

/// What every walk of a pass shares.
struct WalkContext {
    const Scene& scene;
    const PhotonSettings& settings;
    const ArrivalCulling& culling;
    std::span<const ArrivalCulling> frameCullings; ///< for paths that aim at single frames
    const Distribution1D& emitters;
    float frameShift = 0.0f; ///< of the order of frames: over passes, each is aimed at equally often
    bool storeSurface = false, storeVolume = false;
    bool connects = false; ///< to surfaces: SurfaceConnections
    /// Photons without power where connections bring the light: gathers of the nearest take their radius from how dense
    /// photons are, not from how dense those few are that bring what connections cannot.
    bool densityPhotons = false;
    bool glossySensorPaths = false;             ///< SensorPathRules::glossy
    const RecordCounts* recordCounts = nullptr; ///< of guided paths
    const FirstUsefulness* first = nullptr;     ///< likewise: in bodies that light must leave
    FirstUsefulness* measured = nullptr;        ///< of pilot paths, which end at their first vertex there
    PassWatch watch{};
};

struct LightPath {
    LightPath(const WalkContext& walkContext, const Sampler& ownSampler, Deposits& ownDeposits,
              WalkCounters& ownCounters)
        : context(walkContext), culling(&walkContext.culling), sampler(ownSampler), deposits(ownDeposits),
          counters(ownCounters) {}

    /// When light that is recorded as it arrives would have left: emission time and a delay that is drawn.
    void startAt(const Emitter& emitter);
    /// By the emitter's own distribution; `probability` is that of its choice. False ends the path.
    bool emitFrom(const Emitter& emitter, float probability, const Vec2f& uPosition);
    /// A photon with bounce b takes part in paths of at least b interactions.
    [[nodiscard]] bool mayBounce() const {
        return bounce < std::min(context.scene.transport.maxBounces - 1, MostPhotonBounces);
    }
    /// To a vertex in a medium after a flight of this length; its direction is yet to be drawn.
    void collide(const Vec3f& position, double length);
    /// From where the path is to a point as it is stored, so that times are those of the path that is gathered.
    [[nodiscard]] double distanceTo(const Vec3f& position) const;
    /// When light gets there, in this medium.
    [[nodiscard]] double timeAt(const Vec3f& position) const {
        return time + distanceTo(position) / double(region.speed);
    }
    /// Time, bounce and deposit; `surface` is set. False ends the path.
    bool arriveOnSurface(const SurfaceHit& hit);
    /// By the BSDF. False ends the path.
    bool leaveSurface();

    /// False, and counted if it is not finite, for a power that leaves nothing.
    bool bears(const Rgb& carried);
    /// False if it cannot be gathered.
    bool deposit(DepositList<Photon>& list, const Vec3f& position, const Rgb& carried, int medium);
    /// A flight through a medium up to `reach`.
    void depositBeam(DepositList<PhotonBeam>& beams, const Medium& medium, float reach);
    /// What the records draw that are left here: there may be any number of them.
    enum class RecordsOf : uint32_t { Light, Flight, Vertex, Surface, End, Count };
    [[nodiscard]] Sampler records(RecordsOf left, int further = 0) const {
        return sampler.branch(RandomStream::Record,
                              uint64_t(bounce + further) * uint64_t(RecordsOf::Count) + uint64_t(left));
    }
    /// What the chain's records obey.
    [[nodiscard]] FlightChain::Rules chainRules() const;
    /// What the light leaves for a primitive that has arrived at `position` on `surface`: of slices, a ball.
    void leaveOnSurface(FlightChain& chain, const Vec3f& position) {
        if (context.storeVolume) std::visit([&](auto& list) { leaveBall(list, chain, position); }, deposits.volume);
    }
    /// Whether what has been scattered so often in this medium is to be stored, counting `further` scatterings.
    [[nodiscard]] bool orderCounts(int further = 0) const {
        return context.settings.lowOrderScattering || consecutiveMedium + further > 1;
    }

    const WalkContext& context;
    const ArrivalCulling* culling;
    Sampler sampler;
    Deposits& deposits;
    WalkCounters& counters;

    SurfaceInteraction surface; ///< where the path is, between arriving and leaving
    Ray ray;
    Region region;
    Rgb power{0.0f};
    double time = 0.0;
    int bounce = 0;
    int flights = 0;           ///< distances sampled since the last surface
    int consecutiveMedium = 0; ///< medium vertices since the last light or surface
    bool connectable = false;  ///< the last vertex has no single direction and lies in this region: it connects
    bool fromLight = true;     ///< nothing has scattered since the light but mirrors and refraction

  private:
    /// Whether sensor paths along its glossy lobes find the light that arrives on `surface`.
    [[nodiscard]] bool foundBySensorPaths() const;
    void leaveBall(OneOf<DepositList<Photon>, DepositList<PhotonBeam>> auto&, FlightChain&, const Vec3f&) {}
    void leaveBall(DepositList<CollapsedFlights>& list, FlightChain& chain, const Vec3f& position);
};

} // namespace tungsten::photon
