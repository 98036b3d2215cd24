#pragma once
// A path that is guided towards one target: where it has got to, and what its techniques ask of it. Each technique
// (src/path/techniques) connects, or draws, from here; how dense others would have found the same path it asks them.

#include "path/ArrivalBound.h"
#include "path/CameraPath.h"
#include "path/PathTarget.h"

#include "transport/GuidedSteps.h"

namespace tungsten::path {

/// Surfaces that light may be followed to: all lobes smooth, none transmits.
bool endsReflectedLight(LobeMask lobes);

class LightPaths;

/// Sampling by medium.
struct PathGuides {
    std::vector<darts::Guide> media;    ///< for scattering in it, and flights
    std::vector<darts::Guide> surfaces; ///< for leaving a surface into it
    std::vector<darts::Guide> glossy;   ///< the same for surfaces without diffuse lobes
    std::vector<darts::Guide> view;     ///< for flights from the camera
    std::vector<darts::Guide> plain;    ///< bounds in time alone, where refraction hides where light goes

    /// Of directions, in use: one for every medium that has one.
    [[nodiscard]] size_t tables() const {
        return size_t(std::count_if(media.begin(), media.end(), [](const darts::Guide& guide) {
            return guide.settings().direction == darts::Direction::Eda;
        }));
    }
};

/// What guided walks share.
struct GuidedContext {
    const Scene& scene;
    const PathSettings& settings;
    const transport::Sensor& sensor;
    const PathGuides& guides;
    const TargetChoice* targets; ///< among whose points paths choose where they enter bodies, or null
    const LightPaths& lightPaths;
    const ArrivalBound& bound;
    const transport::WaysOut* waysOut; ///< null: media are taken for infinite
    bool forwardBoundaries;            ///< connections must look through index-matched surfaces
    const PassWatch& watch;
};

/// The vertex at which the present straight way starts, as the densities of what may be found along it need it.
struct LastVertex {
    enum class Kind { Specular, Surface, Medium };
    /// Caches it connected to: they could have found the end of the straight way too.
    enum class Caches { None, LightVertices, ReflectedLightToo };

    Kind kind = Kind::Specular;
    Vec3f position{0.0f}; ///< on a surface
    float pdf = 0.0f;     ///< of its own sampling, for the present direction, per solid angle
    Caches caches = Caches::None;

    [[nodiscard]] bool usesReflectedLight() const { return caches == Caches::ReflectedLightToo; }
};

/// How the walk came to the ray's origin, if the vertex before was connected to reflected light and may end here.
struct Approach {
    float pdf;    ///< by the walk's own sampling, per area or volume
    Vec3f normal; ///< of the surface here, on the side of the vertex before; 0 in media
};

/// Path lengths, half open.
struct LengthsInGate {
    float low, high;
};

struct GuidedPath {
    GuidedPath(const GuidedContext& sharedContext, PixelSink& sink, PathCounters& counters, const Sampler& sampler)
        : context(sharedContext), state(sharedContext.scene, sink, counters, sampler) {}

    [[nodiscard]] const Scene& scene() const { return context.scene; }
    [[nodiscard]] float next() { return state.sampler.next1D(); }

    /// The straight way from `position` to the target, if there is one and light on it may fall into the gate; `time`
    /// is the path's up to there.
    [[nodiscard]] std::optional<transport::Straight> wayInTime(const Vec3f& position, double time) const {
        const auto way = transport::straightWay(position, target->vertex.position());
        return way && context.bound.mayConnect(time, way->distance, target->start) ? way : std::nullopt;
    }
    /// What connects to the target, through index-matched boundaries.
    [[nodiscard]] transport::Connector connector() const { return {scene(), context.forwardBoundaries}; }
    /// From the vertex at the ray's origin, through the present region alone. None, too, where margins leave nothing of
    /// the way.
    [[nodiscard]] std::optional<transport::Connection> connectInRegion(const transport::Vertex& here,
                                                                       const transport::ConnectionEnd& end);
    /// The last vertex of what the camera sees, as it is met by the ray.
    [[nodiscard]] transport::Vertex vertexOn(const SurfaceInteraction& surface) const {
        return {scene(), surface, state.ray.direction, TransportMode::Radiance, state.region};
    }

    /// Of what arrives at the ray's origin inside the gate, from the target.
    [[nodiscard]] LengthsInGate lengthsInGate() const;
    /// Whether a path with this many further interactions and medium scatters counts.
    [[nodiscard]] bool counts(int interactions, int mediumScatters) const {
        const transport::BounceLimits& limits = context.settings.limits;
        return limits.renders(state.interactions + interactions + target->interactions) &&
               limits.orderCounts(state.mediumScatters + mediumScatters + target->mediumScatters);
    }
    [[nodiscard]] bool mayFly(const Medium* medium) const { return !medium || state.flights < medium->maxBounces; }

    [[nodiscard]] const darts::Guide& guideOf(const Region& region) const {
        const bool connects = step.residual().exit.connects;
        return (connects ? context.guides.media : context.guides.plain)[size_t(region.medium)];
    }
    /// The guide of the medium before a surface all of whose lobes are smooth and reflect; none elsewhere. `back` is
    /// the way there from the present region, turned round.
    [[nodiscard]] const darts::Guide* guideFor(const transport::Vertex& vertex, const Vec3f& back) const;
    /// Of a connection from a vertex with this residual.
    [[nodiscard]] darts::ConnectionSample drawConnection(const darts::Guide& guide, const darts::Residual& residual);
    /// Ordinary connections share with control vertices: in bodies that light must leave, whose directions do not
    /// follow the connections' weights so closely.
    [[nodiscard]] bool sharesConnections() const {
        return step.residual().way != darts::Way::Through && !context.sensor.gate.delta;
    }

    const GuidedContext& context;
    const PathTarget* target = nullptr;
    CameraPath state;
    transport::GuidedSteps step; ///< looks from the ray's origin
    LastVertex last;
    std::optional<Approach> approach;
};

} // namespace tungsten::path
