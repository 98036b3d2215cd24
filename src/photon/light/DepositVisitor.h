#pragma once
// What light paths leave on their way for the primitive in use, on surfaces and for visible surface points. Plain and
// guided paths leave the same, but that guided ones have control vertices for photons of points. Where both are traced
// side by side, each record is weighed by how densely both leave it, whoever may gather it.

#include "photon/PhotonSettings.h"
#include "photon/light/PhotonTrail.h"
#include "photon/light/StepsToCamera.h"
#include "photon/primitives/VolumePrimitive.h"
#include "photon/primitives/sliced/RecordBudget.h"
#include "photon/primitives/sliced/SliceBuilder.h"
#include "photon/store/ArrivalCulling.h"
#include "photon/surface/SurfaceConnections.h"

#include "transport/Balance.h"
#include "transport/PlainSteps.h"

#include <optional>
#include <span>

namespace tungsten::photon {

/// What a record was weighed by beside the other strategy's paths.
struct Weighed {
    float weight = 1.0f;   ///< of the strategy's own estimate
    float logRatio = 0.0f; ///< log of the density of guided paths over that of plain ones
    transport::Found found = transport::Found::OnWay;
};
/// What pilot paths note of records: one of these for every record, in their order.
struct WeighedRecords {
    std::vector<Weighed> volume, surface, received;
};

/// What consecutive light paths leave behind, with each path's share.
struct Deposits {
    explicit Deposits(const VolumePrimitive& primitive) : volume(depositsOf(primitive)) {}

    DepositList<Photon> surface;
    VolumeDeposits volume;
    std::vector<ConnectionRecord> received;
    std::vector<float>
        expectedLight; ///< light of each vertex's connections, where nobody knows yet what one is to bring

    std::optional<WeighedRecords> weighed;

    [[nodiscard]] size_t volumeRecords() const {
        return std::visit([](const auto& list) { return list.records.size(); }, volume);
    }

    void endPath() {
        surface.endPath();
        std::visit([](auto& list) { list.endPath(); }, volume);
    }
};

using transport::PathState;

struct PhotonCounters : transport::StepCounters {
    uint64_t controlVertices = 0;
    /// Photons that reached the test of arrival on their way to the volume store, and those that passed it.
    uint64_t volumeDeposits = 0, countingDeposits = 0;
    uint64_t nonFinite = 0;                 ///< powers: nothing was stored
    uint64_t paths = 0, connectionRays = 0; ///< the latter are among the rays, too
    uint64_t plainPaths = 0,
             densities = 0; ///< beside guided paths; flights that were asked how densely these take them
};

/// What every light path of a pass shares.
struct PhotonContext {
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
    bool glossyCameraSubpaths = false;          ///< CameraSubpathRules::glossy
    const RecordBudget* recordCounts = nullptr; ///< of paths that draw their records' directions
    transport::StrategyBalance balance{};       ///< of plain and guided paths
    ProgressToken watch{};
};

/// Plain light paths: flights and directions by the scene's own distributions, and whole rays for beams and slices.
using PlainPhotonSteps =
    transport::PlainSteps<transport::PlainOptions{.mode = TransportMode::Photons, .wholeRays = true}>;

/// Throughputs of its walks are powers.
class DepositVisitor : public transport::VisitorBase {
  public:
    /// `culling`: of the gate that the path aims at. `guidance`, null of plain paths alone; `connections` may be null,
    /// too. `trail`: of plain paths beside guided ones.
    DepositVisitor(const PhotonContext& context, const ArrivalCulling& culling, const PhotonGuidance* guidance,
                   const SurfaceConnections* connections, PhotonTrail* trail, Deposits& deposits,
                   PhotonCounters& counters)
        : context_(&context), culling_(&culling), guidance_(guidance), connections_(connections), trail_(trail),
          deposits_(&deposits), counters_(&counters), limits_(context.scene.transport) {}

    // Emission. False if nothing leaves that could be in time.
    bool emit(PathState& path, PlainPhotonSteps& steps);
    bool emit(PathState& path, StepsToCamera& steps);

    /// A photon after b interactions takes part in paths of at least b + 1.
    [[nodiscard]] bool mayGoOn(const PathState& path) const {
        return limits_.mayGoOn(path.interactions + 1) && path.interactions < MostPhotonBounces;
    }
    bool ahead(PathState& path, auto& steps, const transport::Ahead& ahead);
    bool arrive(PathState& path, auto& steps, const transport::Ahead& ahead, const transport::Flight& flight);
    bool vertex(PathState& path, auto& steps, const transport::WalkVertex& vertex);
    void leave(PathState& path, auto& steps, const transport::WalkVertex& vertex, const transport::Way& way);
    void end(PathState& path) { endChain(path, path.interactions); }

  private:
    template <typename Steps>
    static constexpr bool Guided = std::is_same_v<Steps, StepsToCamera>;
    using PointList = DepositList<Photon>;
    using BeamList = DepositList<PhotonBeam>;
    using SliceList = DepositList<SliceRecord>;

    [[nodiscard]] const Scene& scene() const { return context_->scene; }
    /// When light that is recorded as it arrives would have left: emission time and a delay that is drawn.
    void startAt(PathState& path, const Emitter& emitter) const;
    /// Starts the path by the emitter's own distribution; `probability` is that of its choice.
    bool emitFrom(PathState& path, const Emitter& emitter, float probability, const Vec2f& uPosition) const;
    /// Starts the path in a direction that the steps draw, if the emitter has several: plain steps beside guided ones,
    /// or guided ones alone.
    bool emitBySteps(PathState& path, auto& steps, float frames);
    /// From a point of an emitter that shines in more than one direction.
    bool emitFromPoint(PathState& path, auto& steps, const Emitter& emitter, float probability);

    // Weights of what is left, beside the other strategy's paths: for the way up to the flight at hand, to its end, and
    // to the vertex there if paths go on.
    [[nodiscard]] Weighed weigh(float logRatio) const {
        const transport::StrategyBalance& balance = context_->balance;
        return {trail_ ? balance.weightOfPlain(logRatio) : balance.weightOfGuided(logRatio), logRatio};
    }
    [[nodiscard]] bool weighs() const { return context_->balance.both(); }
    [[nodiscard]] Weighed weightOnFlight(const PathState& path) {
        return weighs() ? weigh(trail_ ? trail_->onFlight() : path.logRatio) : Weighed{};
    }
    [[nodiscard]] Weighed weightThere(const PathState& path) {
        return weighs() ? weigh(trail_ ? trail_->there() : path.logRatio) : Weighed{};
    }
    [[nodiscard]] Weighed weightAtVertex(const PathState& path) {
        return weighs() ? weigh(trail_ ? trail_->atVertex() : path.logRatio) : Weighed{};
    }
    /// Notes the weights of the records that have been added last.
    void noteVolume(const Weighed& weighed) {
        if (deposits_->weighed) deposits_->weighed->volume.resize(deposits_->volumeRecords(), weighed);
    }
    /// Whether what has been scattered so often in this medium is to be stored, counting `further` scatterings.
    [[nodiscard]] bool orderCounts(const PathState& path, int further = 0) const {
        return context_->settings.lowOrderScattering || path.inARow + further > 1;
    }
    /// False, and counted if it is not finite, for a power that leaves nothing.
    bool bears(const Rgb& power);

    // Surfaces.
    void depositOnSurface(const PathState& path, const transport::WalkVertex& at);
    void depositOnSurface(const PathState& path, const SurfaceInteraction& surface);
    /// Whether camera subpaths along its glossy lobes find the light that arrives on `surface`.
    [[nodiscard]] bool foundByCameraSubpaths(const PathState& path, const SurfaceInteraction& surface) const;
    /// `light`: the vertex is a light's point, which both strategies choose alike.
    void connectToSurfaces(const PathState& path, const darts::TimeGate& gate, const transport::Vertex& vertex,
                           float meanScattering, bool light = false);
    [[nodiscard]] darts::TimeGate gateOf(auto& steps) const {
        if constexpr (Guided<std::decay_t<decltype(steps)>>)
            return steps.gate();
        else
            return guidance_->gate();
    }

    // What is left for a primitive on a flight, and at a collision; of slices, too, at lights and on surfaces.
    void depositOnFlight(PathState& path, auto& steps, const transport::Ahead& ahead, PointList& points);
    void depositOnFlight(PathState& path, auto& steps, const transport::Ahead& ahead, BeamList& beams);
    void depositOnFlight(PathState& path, auto& steps, const transport::Ahead& ahead, SliceList& slices);
    void depositAtVertex(PathState& path, auto& steps, const transport::Flight& flight, const Medium& medium,
                         PointList& points);
    void depositAtVertex(PathState&, auto&, const transport::Flight&, const Medium&, BeamList&) {}
    void depositAtVertex(PathState& path, auto& steps, const transport::Flight& flight, const Medium& medium,
                         SliceList& slices);
    /// `weight()`: of its power, asked only if it counts.
    template <typename Weight>
    void store(const ArrivalCulling& culling, Photon photon, PointList& points, Weight&& weight);
    /// What the records draw that are left here: there may be any number of them.
    enum class RecordsOf : uint32_t { Light, Flight, Vertex, Surface, End, Count };
    [[nodiscard]] static Sampler records(const PathState& path, int interactions, RecordsOf left) {
        return path.random.branch(RandomStream::Record,
                                  uint64_t(interactions) * uint64_t(RecordsOf::Count) + uint64_t(left));
    }
    [[nodiscard]] SliceBuilder::Rules chainRules() const;
    /// Calls use(slices) if they are the primitive in use.
    template <typename Use>
    void withSlices(Use&& use) {
        if (auto* slices = std::get_if<SliceList>(&deposits_->volume)) use(*slices);
    }
    /// The path meets a surface, or ends, after so many interactions.
    void endChain(const PathState& path, int interactions);

    const PhotonContext* context_;
    const ArrivalCulling* culling_;
    const PhotonGuidance* guidance_;
    const SurfaceConnections* connections_;
    PhotonTrail* trail_;
    Deposits* deposits_;
    PhotonCounters* counters_;
    transport::BounceLimits limits_;
    std::vector<VisiblePointSample> draws_; ///< of the vertex at hand
    SliceBuilder chain_;                    ///< of the flights since the last light or surface, for slices
    bool connectable_ = false; ///< the last vertex has no single direction and lies in this region: it connects
};

/// Traces one light path, plain.
void tracePlainPhotons(const PhotonContext& context, const Sampler& sampler, Deposits& deposits,
                       PhotonCounters& counters);
/// Traces plain paths beside guided ones; `densities` counts what these are asked, `trail` is memory.
void tracePlainBesideGuided(const PhotonContext& context, const PhotonGuidance& guidance,
                            const SurfaceConnections* connections, const Sampler& sampler, PhotonTrail& trail,
                            Deposits& deposits, PhotonCounters& counters, PhotonCounters& densities);
/// The same, guided. `path` is its index in the run: frames are chosen in turn. `connections` may be null.
void traceGuidedPhotons(const PhotonContext& context, const PhotonGuidance& guidance,
                        const SurfaceConnections* connections, const Sampler& sampler, uint64_t path,
                        Deposits& deposits, PhotonCounters& counters);

} // namespace tungsten::photon
