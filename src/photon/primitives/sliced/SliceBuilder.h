#pragma once
// The flights of a light path since its last surface or light, as they come, and what they leave.

#include "photon/primitives/sliced/RecordBudget.h"
#include "photon/primitives/sliced/Slices.h"
#include "photon/store/ArrivalCulling.h"

#include "tungsten/scene/Interaction.h"

namespace tungsten::photon {

/// Where a flight begins.
struct BaseVertex {
    Vec3f position, direction; ///< of the flight
    Rgb power;                 ///< leaving along it
    double time;
    float reach; ///< to the next surface
    int bounce;
};

class SliceBuilder {
  public:
    struct Rules {
        const Scene& scene;
        const ArrivalCulling& arrival;
        SliceClasses classes;
        /// Numbers of records for guided paths: every base draws directions for as many records as its light calls for.
        /// Null: a base has the directions of the path, and ghosts.
        const RecordBudget* counts = nullptr;
    };

    /// The path begins at an emitter; `probability` is that of its choice.
    void beginAt(const Scene& scene, const Emitter& emitter, float probability, const Vec2f& u);
    /// Starts at a point of the light that is known, and leaves its ball here: guided paths may go where it does not
    /// shine.
    void recordLight(const Rules& rules, const Emitter& emitter, float probability, const SurfaceSample& light,
                     const BaseVertex& start, int medium, Sampler& sampler, DepositList<SliceRecord>& list);
    /// Light has arrived on a surface and will leave it: `at` has the arriving power and direction, and the bounces
    /// with this one. A ball there, if it scatters evenly.
    void recordSurface(const Rules& rules, const SurfaceInteraction& surface, const BaseVertex& at,
                       const Region& region, Sampler& sampler, DepositList<SliceRecord>& list);
    /// A flight through a medium.
    void fly(const Rules& rules, const BaseVertex& vertex, int medium, Sampler& sampler,
             DepositList<SliceRecord>& list);
    /// A scattering with the power that collides, reached by the last flight.
    void scatter(const Rules& rules, const BaseVertex& vertex, Sampler& sampler, DepositList<SliceRecord>& list);
    /// The path leaves the medium, or ends. Bases that still lack directions get ghosts: whether a record is made must
    /// not depend on the lengths that it integrates over.
    void end(const Rules& rules, Sampler& sampler, DepositList<SliceRecord>& list);
    /// Ends a path whose bases draw their own directions.
    void end() {
        flights_ = 0;
        emitter_ = -1;
        ballSide_ = Vec3f(0.0f);
    }

  private:
    static constexpr int Most = 4; ///< flights of a record

    /// Records whose last direction is that of flight `last`.
    void complete(const Rules& rules, int last, Sampler& sampler, DepositList<SliceRecord>& list) const;
    /// Records from the base of the flight at hand, with directions of their own.
    void branch(const Rules& rules, Sampler& sampler, DepositList<SliceRecord>& list) const;
    /// Deposits a beam of at most the length `most`.
    void depositBeam(const Rules& rules, const BaseVertex& start, float most, Sampler& sampler,
                     DepositList<SliceRecord>& list) const;
    void depositLight(const Rules& rules, BaseVertex start, Sampler& sampler, DepositList<SliceRecord>& list) const;
    [[nodiscard]] static bool counts(const Rules& rules, const BaseVertex& base, int medium, int chain, int flights);
    /// Leaves a share of them, or as many as their light calls for: none or one.
    static void thin(const Rules& rules, SliceRecord flights, Sampler& sampler, DepositList<SliceRecord>& list);
    [[nodiscard]] SliceRecord record(const Rules& rules, const BaseVertex& base, FlightShape shape,
                                     Sampler& sampler) const;
    [[nodiscard]] const BaseVertex& at(int flight) const { return vertices_[size_t(flight % Most)]; }
    [[nodiscard]] const Vec3f& direction(int flight) const { return directions_[size_t(flight % Most)]; }

    std::array<BaseVertex, Most> vertices_;
    std::array<Vec3f, Most> directions_;
    int flights_ = 0; ///< so far, and real
    int medium_ = -1;
    int emitter_ = -1; ///< of the first flight, if it can be seen in more than one direction
    float inverseProbability_ = 0.0f;
    SurfaceSample light_;
    Vec3f ballSide_{0.0f}; ///< normal on the side that a ball on the last surface lights; 0 without one
};

} // namespace tungsten::photon
