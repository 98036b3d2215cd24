#pragma once
// What techniques ask of a guided path. Each technique (src/path/techniques) connects, or draws, from where it is; how
// dense others would have found the same path it asks them.

#include "path/PixelSink.h"
#include "path/StepsToEmitter.h"

namespace tungsten::path {

/// What the last vertex connected to besides the target: it could have found the end of the present straight way, too.
enum class Caches { None, LightVertices, ReflectedLightToo };

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

/// A view of the walk at hand and of what its visitor keeps.
struct GuidedPath {
    const GuidedContext& context;
    PixelSink& sink;
    PathCounters& counters;
    PathState& state;
    StepsToEmitter& steps;
    Caches caches; ///< of state.last
    const std::optional<Approach>& approach;
    const LogRatios& ratios;

    /// Of paths whose last vertex is the surface ahead. Light vertices and reflected light find them from one and two
    /// vertices before: what is weighed is then the way up to there.
    [[nodiscard]] float logRatioOnSurface(LobeMask lobes) const;
    [[nodiscard]] const Scene& scene() const { return context.scene; }
    [[nodiscard]] const PathTarget& target() const { return steps.target(); }
    [[nodiscard]] float next() const { return state.random.next1D(); }

    /// The straight way from `position` to the target, if there is one and light on it may fall into the gate; `time`
    /// is the path's up to there.
    [[nodiscard]] std::optional<transport::Straight> wayInTime(const Vec3f& position, double time) const {
        const auto way = transport::straightWay(position, target().vertex.position());
        return way && context.bound.mayConnect(time, way->distance, target().start) ? way : std::nullopt;
    }
    /// What connects to the target, through index-matched boundaries.
    [[nodiscard]] transport::Connector connector() const { return {scene(), context.forwardBoundaries}; }
    /// From the vertex at the ray's origin, through the present region alone. None, too, where margins leave nothing of
    /// the way.
    [[nodiscard]] std::optional<transport::Connection> connectInRegion(const transport::Vertex& here,
                                                                       const transport::ConnectionEnd& end) const {
        if (!(here.margin().beyond(end.direction) < end.margin.before(end.direction, end.distance)))
            return std::nullopt;
        return transport::Connector(scene(), false).connect(here, state.throughput, end, counters.shadowRays);
    }
    /// The last vertex of what the camera sees, as it is met by the ray.
    [[nodiscard]] transport::Vertex vertexOn(const SurfaceInteraction& surface) const {
        return {scene(), surface, state.ray.direction, TransportMode::Radiance, state.region};
    }

    /// Of what arrives at the ray's origin inside the gate, from the target.
    [[nodiscard]] LengthsInGate lengthsInGate() const {
        const TimeGate& gate = context.sensor.arrivals;
        const double speed = double(state.region.speed), elapsed = state.time + target().start;
        return {float(speed * (gate.start - elapsed)), float(speed * (gate.end() - elapsed))};
    }
    /// Whether a path with this many further interactions and medium scatters counts.
    [[nodiscard]] bool counts(int interactions, int mediumScatters) const {
        const transport::BounceLimits& limits = context.settings.limits;
        return limits.renders(state.interactions + interactions + target().interactions) &&
               limits.orderCounts(state.mediumScatters + mediumScatters + target().mediumScatters);
    }
    [[nodiscard]] bool mayFly(const Medium* medium) const { return !medium || state.flights < medium->maxBounces; }
    /// Of a surface where light ends, met from the present region (StepsToEmitter::guideFor).
    [[nodiscard]] const darts::Guide* guideFor(const transport::Vertex& vertex, const Vec3f& back) const {
        return steps.guideFor(vertex, back, state.region);
    }
};

} // namespace tungsten::path
