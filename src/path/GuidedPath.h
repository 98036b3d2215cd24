#pragma once
// Guided camera paths: everything is connected to one target (docs/method.md, sections 3 to 6).
//
// Every path is found in one way or by weighted ways, told apart by the last vertex before the emitter: in a medium
// with a straight connection at one speed: a control vertex; in a medium otherwise: an ordinary connection; on a
// surface: an ordinary connection from where the walk meets it, a light vertex, or, glossy, reflected light one vertex
// before, weighted against each other and against emitters that the walk meets; specular, or none: emitters that the
// walk meets. Each way is a technique in src/path/techniques, which connects, or draws, from where the path is; how
// dense others would have found the same path it asks them.

#include "path/PixelAccumulator.h"
#include "path/StepsToEmitter.h"

namespace tungsten::path {

/// What the last vertex connected to besides the target: it could have found the end of the present straight way, too.
enum class Caches { None, LightVertices, GlossyVerticesToo };

/// How the walk came to the ray's origin, if the vertex before was connected to reflected light and may end here.
struct Approach {
    float pdf;    ///< by the vertex' own distribution, per area or volume
    Vec3f normal; ///< of the surface here, on the side of the vertex before; 0 in media
};

/// Path lengths, half open.
struct LengthsInGate {
    float low, high;
};

/// Logarithms of how densely guided paths come by a walk's way, over plain ones.
struct LogRatios {
    float there = 0.0f;  ///< up to the last vertex
    float before = 0.0f; ///< up to the one before it
};

/// What techniques need of the way behind a walk, or behind a plain path that guided ones are compared with.
struct WayBehind {
    Caches caches = Caches::None;     ///< of the last vertex
    std::optional<Approach> approach; ///< to it
    LogRatios ratios;

    /// The walk comes to another vertex; `logRatio` is that of the way up to there.
    void arrive(float logRatio) { ratios.before = std::exchange(ratios.there, logRatio); }
    /// Which is in a medium, after a flight of this length.
    void approachInMedium(const GuidedContext& context, const PathState& path, float distance);
    /// Or on a surface, from which `steps` may have a guide.
    void approachOnSurface(const StepsToEmitter& steps, const PathState& path, const transport::Vertex& here,
                           const SurfaceHit& hit);
    /// And may connect to light vertices of this emitter, and to reflected light.
    void connect(const GuidedContext& context, int emitter, const PathState& path);

  private:
    /// By so many per area or volume; `normal` as in Approach. What has been connected to along the way is over.
    void approachBy(float pdf, const Vec3f& normal);
};

/// A view of the walk at hand and of what its visitor keeps.
struct GuidedPath {
    const GuidedContext& context;
    PixelAccumulator& sink;
    PathCounters& counters;
    PathState& state;
    StepsToEmitter& steps;
    const WayBehind& behind;

    /// Logarithm of the density of guided over plain paths whose last vertex is this surface ahead, where light
    /// vertices, or reflected light, find them too and leave the walk this share. What is weighed is the way up to one
    /// or two vertices before, where these connect.
    [[nodiscard]] float logRatioByLightCaches(const transport::Vertex& surface, float shareOfWalk) const;
    [[nodiscard]] const Scene& scene() const { return context.scene; }
    [[nodiscard]] const PathTarget& target() const { return steps.target(); }
    [[nodiscard]] float next() const { return state.random.next1D(); }

    /// The straight way from `position` to the target, if there is one and light on it may fall into the gate; `time`
    /// is the path's up to there.
    [[nodiscard]] std::optional<transport::Segment> wayInTime(const Vec3f& position, double time) const {
        const auto way = transport::connectionSegment(position, target().vertex.position());
        return way && context.bound.mayConnect(time, way->distance, target().start) ? way : std::nullopt;
    }
    /// What connects to the target, through index-matched boundaries.
    [[nodiscard]] transport::Connector connector() const { return {scene(), context.forwardBoundaries}; }
    /// From the vertex at the ray's origin, through the present region alone. None, too, where margins leave nothing of
    /// the way.
    [[nodiscard]] std::optional<transport::Connection> connectInRegion(const transport::Vertex& here,
                                                                       const transport::ConnectionEndpoint& end) const {
        if (!(here.margin().beyond(end.direction) < end.margin.before(end.direction, end.distance)))
            return std::nullopt;
        return transport::Connector(scene(), false).connect(here, state.throughput, end, counters.shadowRays);
    }
    /// The probability that a plain path's flight of this length into the region at hand, or one like it, passes.
    [[nodiscard]] float plainlyPasses(const Region& region, float distance) const {
        const Medium* medium = scene().medium(region);
        return medium ? probabilityFlightExits(*medium, distance, state.channels) : 1.0f;
    }
    /// The last vertex of what the camera sees, as it is met by the ray.
    [[nodiscard]] transport::Vertex vertexOn(const SurfaceInteraction& surface) const {
        return {scene(), surface, state.ray.direction, TransportMode::Radiance, state.region};
    }

    /// Lengths of what arrives at the ray's origin in time, from the target.
    [[nodiscard]] LengthsInGate lengthsInGate() const {
        const transport::TimeWindow& gate = steps.window();
        const double speed = double(state.region.speed), elapsed = state.time + target().start;
        return {float(speed * (gate.begin - elapsed)), float(speed * (gate.end - elapsed))};
    }
    /// Whether a path with this many further interactions and medium scatters counts.
    [[nodiscard]] bool counts(int interactions, int mediumScatters) const {
        const transport::BounceLimits& limits = context.settings.limits;
        return limits.renders(state.interactions + interactions + target().interactions) &&
               limits.orderCounts(state.mediumScatters + mediumScatters + target().mediumScatters);
    }
    /// Guide at a surface where light ends, met from the present region (StepsToEmitter::guideFor).
    [[nodiscard]] const darts::Guide* guideFor(const transport::Vertex& vertex, const Vec3f& back) const {
        return steps.guideFor(vertex, back, state.region);
    }
};

/// What guided camera paths do on their way.
class GuidedVisitor : public transport::VisitorBase {
  public:
    GuidedVisitor(const GuidedContext& context, PixelAccumulator& sink, PathCounters& counters)
        : context_(&context), sink_(&sink), counters_(&counters) {}

    [[nodiscard]] bool mayGoOn(const PathState& path) const { return limits().mayGoOn(path.interactions); }
    bool ahead(PathState& path, StepsToEmitter& steps, const transport::Ahead& ahead);
    bool arrive(PathState& path, StepsToEmitter& steps, const transport::Ahead& ahead, const transport::Flight& flight);
    bool vertex(PathState& path, StepsToEmitter& steps, const transport::WalkVertex& vertex);

  private:
    [[nodiscard]] const transport::BounceLimits& limits() const { return context_->settings.limits; }
    [[nodiscard]] GuidedPath at(PathState& path, StepsToEmitter& steps) const {
        return {*context_, *sink_, *counters_, path, steps, behind_};
    }
    /// Connects the vertex at the ray's origin to light vertices and reflected light.
    void connectToLightCaches(const GuidedPath& path, const transport::Vertex& here);

    const GuidedContext* context_;
    PixelAccumulator* sink_;
    PathCounters* counters_;
    WayBehind behind_;
    StepsToEmitter::InMedium inMedium_{}; ///< of paths whose last vertex is where the walk is
};

/// Traces one camera path along `ray`, guided towards the target, at the window that the sink has been told.
void traceGuidedPath(const GuidedContext& context, PixelAccumulator& sink, PathCounters& counters,
                     const Sampler& sampler, const PathTarget& target, const Ray& ray, size_t window = 0);

} // namespace tungsten::path
