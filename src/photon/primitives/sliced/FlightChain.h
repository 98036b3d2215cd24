#pragma once
// The flights of a light path since its last surface or light, as they come, and what they leave.

#include "photon/primitives/sliced/RecordCounts.h"
#include "photon/primitives/sliced/SliceKind.h"
#include "photon/store/ArrivalCulling.h"

#include "tungsten/scene/Interaction.h"

namespace tungsten::photon {

/// Where a flight begins.
struct ChainVertex {
    Vec3f position, direction; ///< of the flight
    Rgb power;                 ///< leaving along it
    double time;
    float reach; ///< to the next surface
    int bounce;
};

class FlightChain {
  public:
    struct Rules {
        const Scene& scene;
        const ArrivalCulling& arrival;
        SliceClasses classes;
        /// Of guided paths: every base draws directions for as many records as their light calls for. Null: those of
        /// the path, and ghosts.
        const RecordCounts* counts = nullptr;
    };

    /// The path begins at an emitter; `probability` is that of its choice.
    void beginAt(const Scene& scene, const Emitter& emitter, float probability, const Vec2f& u);
    /// The same at a point that is known, which leaves its ball here: guided paths may go where it does not shine.
    void leaveLight(const Rules& rules, const Emitter& emitter, float probability, const SurfaceSample& light,
                    const ChainVertex& start, int medium, Sampler& sampler, DepositList<CollapsedFlights>& list);
    /// Light has arrived on a surface and will leave it: `at` has the arriving power and direction, and the bounces
    /// with this one. A ball there, if it scatters evenly.
    void leaveSurface(const Rules& rules, const SurfaceInteraction& surface, const ChainVertex& at,
                      const Region& region, Sampler& sampler, DepositList<CollapsedFlights>& list);
    /// A flight through a medium.
    void fly(const Rules& rules, const ChainVertex& vertex, int medium, Sampler& sampler,
             DepositList<CollapsedFlights>& list);
    /// A scattering with the power that collides, reached by the last flight.
    void scatter(const Rules& rules, const ChainVertex& vertex, Sampler& sampler, DepositList<CollapsedFlights>& list);
    /// The path leaves the medium, or ends. Bases that still lack directions get ghosts: whether a record is made must
    /// not depend on the lengths that it integrates over.
    void end(const Rules& rules, Sampler& sampler, DepositList<CollapsedFlights>& list);
    /// The same of paths whose bases draw their own directions.
    void end() {
        flights_ = 0;
        emitter_ = -1;
        ballSide_ = Vec3f(0.0f);
    }

  private:
    static constexpr int Most = 4; ///< flights of a record

    /// Records whose last direction is that of flight `last`.
    void complete(const Rules& rules, int last, Sampler& sampler, DepositList<CollapsedFlights>& list) const;
    /// Records from the base of the flight at hand, with directions of their own.
    void branch(const Rules& rules, Sampler& sampler, DepositList<CollapsedFlights>& list) const;
    /// As long as `most`.
    void depositBeam(const Rules& rules, const ChainVertex& start, float most, Sampler& sampler,
                     DepositList<CollapsedFlights>& list) const;
    void depositLight(const Rules& rules, ChainVertex start, Sampler& sampler,
                      DepositList<CollapsedFlights>& list) const;
    [[nodiscard]] static bool counts(const Rules& rules, const ChainVertex& base, int medium, int chain, int flights);
    /// Leaves a share of them, or as many as their light calls for: none or one.
    static void thin(const Rules& rules, CollapsedFlights flights, Sampler& sampler,
                     DepositList<CollapsedFlights>& list);
    [[nodiscard]] CollapsedFlights record(const Rules& rules, const ChainVertex& base, FlightShape shape,
                                          Sampler& sampler) const;
    [[nodiscard]] const ChainVertex& at(int flight) const { return vertices_[size_t(flight % Most)]; }
    [[nodiscard]] const Vec3f& direction(int flight) const { return directions_[size_t(flight % Most)]; }

    std::array<ChainVertex, Most> vertices_;
    std::array<Vec3f, Most> directions_;
    int flights_ = 0; ///< so far, and real
    int medium_ = -1;
    int emitter_ = -1; ///< of the first flight, if it can be seen in more than one direction
    float inverseProbability_ = 0.0f;
    SurfaceSample light_;
    Vec3f ballSide_{0.0f}; ///< normal on the side that a ball on the last surface lights; 0 without one
};

} // namespace tungsten::photon
