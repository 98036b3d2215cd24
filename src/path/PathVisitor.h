#pragma once
// What plain walks from the camera do on their way: every vertex is connected to a light, and lights are met.

#include "path/ArrivalBound.h"
#include "path/PathSettings.h"
#include "path/PathTarget.h"
#include "path/PixelAccumulator.h"
#include "path/PlainTrail.h"
#include "path/WeightWindows.h"
#include "path/techniques/RefractiveConnections.h"

#include "transport/PlainSteps.h"

#include "tungsten/scene/LightChoice.h"

namespace tungsten::path {

/// What a walk needs to know; shared by all threads.
struct PathContext {
    const Scene& scene;
    const PathSettings& settings;
    const LightChoice& lights;
    const ArrivalBound& bound;
    const RefractiveConnections* refracted; ///< of scenes whose bodies are all sealed, or null
    bool forwardBoundaries;                 ///< connections must look through index-matched surfaces
    const ProgressToken& watch;
    const WeightWindows* windows = nullptr;  ///< null: paths go on as they are
    WeightWindows::Record* record = nullptr; ///< of a path of a pilot
    bool lightsInView = false;               ///< in expectation: see PathVisitor::addLightsInView
};

/// What weighs a plain path's contributions beside guided ones: nothing, where all paths are plain.
struct Alone {
    static constexpr bool Balanced = false;
    void fly(const PathState&, const transport::Ahead&) {}
    void arrive(const PathState&, const transport::Ahead&, const transport::Flight&) {}
    void leave(const transport::Way&) {}
};
/// Guided paths, which aim at a point of one emitter each.
struct BesideGuided {
    static constexpr bool Balanced = true;
    PlainTrail* trail;
    void fly(const PathState& start, const transport::Ahead& ahead) { trail->fly(start, ahead); }
    void arrive(const PathState& at, const transport::Ahead& ahead, const transport::Flight& flight) {
        trail->arrive(at, ahead, flight);
    }
    void leave(const transport::Way& way) { trail->leave(way); }
};

/// Light that starts in a single direction is found through the virtual point source `source`, if there is one. Beside
/// guided paths vertices connect to the trail's targets, which are of any kind. `TimeResolved` off leaves out every
/// test of time.
template <bool TimeResolved, typename Beside = Alone>
class PathVisitor : public transport::VisitorBase {
  public:
    PathVisitor(const PathContext& context, PixelAccumulator& sink, PathCounters& counters, const PathTarget* source,
                const Beside& beside = {})
        : context_(&context), sink_(&sink), counters_(&counters), connector_(context.scene, context.forwardBoundaries),
          source_(source), beside_(beside), record_(context.record) {}

    [[nodiscard]] bool mayGoOn(const PathState& path) const { return limits().mayGoOn(path.interactions); }
    bool ahead(PathState& path, auto& steps, const transport::Ahead& ahead);
    void escape(PathState& path) {
        if (!inExpectation(path)) addEnvironment(path);
    }
    bool arrive(PathState& path, auto& steps, const transport::Ahead& ahead, const transport::Flight& flight);
    bool vertex(PathState& path, auto& steps, const transport::WalkVertex& vertex);
    void leave(PathState& path, auto& steps, const transport::WalkVertex& vertex, const transport::Way& way);

    /// Lights that the path, which has not started, sees straight on through media and forward lobes, attenuated as
    /// transmittance has it: no flight needs to get there.
    void addLightsInView(const PathState& start) const;

  private:
    struct View; ///< visitor of that straight walk
    /// The way out of a sealed body, from its last vertex, as long as it meets nothing but surfaces.
    struct WayOut {
        SealedVertex from;
        Vec3f direction;
        size_t face;
        float pdf; ///< of the direction, times the probability of the flight to the boundary
    };

    [[nodiscard]] const Scene& scene() const { return context_->scene; }
    [[nodiscard]] const PathSettings& settings() const { return context_->settings; }
    [[nodiscard]] const transport::BounceLimits& limits() const { return settings().limits; }
    /// Whether light found at the end of the present flight counts (low_order_scattering, include_surfaces).
    [[nodiscard]] bool orderCounts(const PathState& path, int further = 0) const {
        return limits().orderCounts(path.mediumScatters + further);
    }
    /// Light that the path meets now has been added by addLightsInView().
    [[nodiscard]] bool inExpectation(const PathState& path) const {
        return context_->lightsInView && path.last.kind == transport::LastVertex::Kind::Start;
    }
    /// Guided paths beside this one do not count lights that they meet straight on from a vertex in a medium.
    [[nodiscard]] static bool fromMedium(const PathState& path) {
        return path.last.kind == transport::LastVertex::Kind::Medium;
    }
    /// The present direction was drawn at a vertex that was connected to lights, too.
    [[nodiscard]] bool sharesWithConnections(const PathState& path) const;
    /// Whether light found from the path's vertex on can still arrive inside the gate.
    [[nodiscard]] bool tooLate(const PathState& path) const;
    /// If the surface shines.
    void addEmission(const PathState& path, const SurfaceHit& hit) const;
    void addEnvironment(const PathState& path) const;
    // Light that connections of the vertex bring: of an emitter, and of the virtual source.
    void connectToLight(PathState& path, const transport::Vertex& vertex);
    void connectToTarget(const PathState& path, const transport::Vertex& vertex, const PathTarget& target,
                         size_t emitter = 0);

    // Sealed bodies.
    /// From the vertex: a walk that aims at an emitter through a face.
    void aimThroughWall(const PathState& path, const auto& steps, const Medium& medium) const;
    /// MIS weight of light of an emitter that is met at this time: the part that is not left to connections.
    [[nodiscard]] transport::TechniqueShare shareOfMeeting(const PathState& path, int emitter, const SurfaceHit& hit,
                                                           double time) const;
    /// MIS weight of light of an emitter that is met: the part that is not left to the other way of finding the same
    /// path.
    [[nodiscard]] float refractedShare(int emitter) const;

    const PathContext* context_;
    PixelAccumulator* sink_;
    PathCounters* counters_;
    transport::Connector connector_;
    const PathTarget* source_;
    Beside beside_;
    WeightWindows::Record* record_;      ///< null on ways that are aimed
    std::optional<SealedVertex> sealed_; ///< the last vertex, if it is one of a sealed body
    std::optional<WayOut> wayOut_;
    int aimedAt_ = -1; ///< the emitter, of a walk that follows a drawn way out
};

/// Traces one camera path along `ray` and adds what it finds to the sink.
template <bool TimeResolved, bool Media>
void tracePath(const PathContext& context, PixelAccumulator& sink, PathCounters& counters, const Sampler& sampler,
               const PathTarget* source, const Ray& ray);
/// Traces a plain path beside guided ones, whose trail has been started.
void tracePlainBesideGuided(const PathContext& context, const BesideGuided& beside, PixelAccumulator& sink,
                            PathCounters& counters, const Sampler& sampler, const Ray& ray);

} // namespace tungsten::path
