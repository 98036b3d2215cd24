#pragma once
// Every walk through the scene, from the camera or from a light, plain or guided, is this loop. Steps draw how it goes
// on; a visitor does what is to be done on the way: connections, deposits, light that is met. Neither the loop nor a
// step adds light anywhere.

#include "transport/StepCounters.h"
#include "transport/Vertex.h"

#include "tungsten/scene/Interaction.h"

#include <concepts>
#include <optional>

namespace tungsten::transport {

/// The last vertex that a walk has not passed straight: where its present direction was drawn.
struct LastVertex {
    enum class Kind { Start, Specular, Surface, Medium }; ///< Specular: mirrors and refraction

    Kind kind = Kind::Start;
    Vec3f position{0.0f};
    float pdf = 0.0f; ///< of the present direction, per solid angle (Way::pdf)
};

/// In double, of positions as they are stored.
inline double distanceBetween(const Vec3f& a, const Vec3f& b) {
    const Vec3d d(double(b.x) - double(a.x), double(b.y) - double(a.y), double(b.z) - double(a.z));
    return d.length();
}

/// Where a walk has got to.
/// A value: copies of a walk that is split have one each.
struct PathState {
    Sampler random;       ///< the path's own numbers
    Ray ray{};            ///< ahead, from the last vertex, unit direction; at a vertex: the direction up to there
    Region region{};      ///< medium and speed along it
    Rgb throughput{1.0f}; ///< the path's contribution per channel over its density; walks from lights may hold power
    ChannelDensities channels{1.0f}; ///< of plain flights
    float logRatio = 0.0f;           ///< log of the density of guided paths up to here over that of plain ones
    double time = 0.0;               ///< of flight so far; stands still while `timed` is false
    int interactions = 0;            ///< surfaces met, index-matched ones included, and scatterings in media
    int flights = 0;                 ///< in scattering media since the last surface
    int mediumScatters = 0;
    int inARow = 0;         ///< the last of these, since the last surface
    bool timed = true;      ///< false: on camera segments that do not count, up to the first vertex that scatters
    bool scattered = false; ///< at a surface by a smooth lobe, or in a medium
    LastVertex last{};

    /// The time at the end of a straight way of this length.
    [[nodiscard]] double timeAfter(double length) const { return timed ? time + length / double(region.speed) : time; }
};
static_assert(sizeof(PathState) <= 256, "walks are copied where they are split");

/// Where walks go, who counts what they do, and who may break them off.
struct WalkContext {
    const Scene& scene;
    StepCounters& counters;
    ProgressToken watch;
};

/// What lies ahead of a ray.
struct Ahead {
    bool flies = false;              ///< false: limits, or time, end the walk
    const Medium* medium = nullptr;  ///< that the ray goes through; null in vacuum
    std::optional<SurfaceHit> hit{}; ///< none either where a flight that is drawn first ends before the surface

    [[nodiscard]] float reach() const { return hit ? hit->t : Infinity; }
};

/// How a flight ends.
struct Flight {
    enum class Event { Nothing, Collision, Surface, Escape }; ///< Nothing: nowhere where the walk could still be of use
    Event event = Event::Nothing;
    float distance = Infinity; ///< along the ray
    Rgb weight{1.0f};          ///< collision: sigmaS T / pdf; else T / pdf, T the transmittance
    float pdf = 1.0f;          ///< collision: density per length; else a probability
    double length = distance;  ///< for the clock: some steps take it between the vertices, which are rounded
};

/// The vertex at a flight's end, in a medium or on a surface: one of the two is set.
struct WalkVertex {
    const Medium* medium;
    const SurfaceInteraction* surface;
    Vec3f position;
    Vec3f before;  ///< direction of propagation up to here
    Region region; ///< through which the walk came; canArrive() may have set path.region to what is ahead

    /// This vertex as others are connected to it.
    [[nodiscard]] Vertex connectible(const Scene& scene, TransportMode mode) const {
        return surface ? Vertex(scene, *surface, before, mode, region) : Vertex(*medium, position, before, region);
    }
};

/// How a walk leaves a vertex.
struct Way {
    Ray ray;
    Region region;
    Rgb weight{1.0f}; ///< scattering, on surfaces times cosine, over the density or the probability
    float pdf = 0.0f; ///< per solid angle, by the phase function or the BSDF, whoever drew; 0 for what has none
    LobeMask lobe = lobe::None; ///< of a surface

    [[nodiscard]] bool straight() const { return lobe == lobe::Forward; }
    [[nodiscard]] bool smooth() const { return (lobe & lobe::Smooth) != 0; }
};

/// Along a lobe of the surface's BSDF, of those that are asked for. None when they absorb the path, or when `checks`
/// are on and the direction is on different sides of the geometric and the shading normal.
inline std::optional<Way> sampleSurfaceWay(PathState& path, const WalkVertex& vertex, TransportMode mode, bool checks,
                                           LobeMask lobes = lobe::All) {
    const SurfaceInteraction& surface = *vertex.surface;
    path.random.at(path.interactions, Draw::Direction);
    const auto exit = sampleBsdf(surface, surface.query(mode, lobes), checks, path.random);
    if (!exit) return std::nullopt;
    const bool shades = mode == TransportMode::Photons && !exit->straight();
    return Way{surface.hit.spawnRay(exit->direction), regionBeyond(surface, exit->direction, path.region),
               shades ? exit->weight * surface.photonShadingFactor(-vertex.before, exit->direction) : exit->weight,
               (exit->lobe & lobe::Smooth) != 0 ? exit->pdf : 0.0f, exit->lobe};
}

/// Draws a direction by the phase function.
inline Way sampleMediumWay(PathState& path, const WalkVertex& vertex) {
    path.random.at(path.interactions, Draw::Direction);
    const PhaseFunction& phase = vertex.medium->phase;
    const Vec3f direction = phase.sample(vertex.before, path.random.next2D());
    return {Ray{vertex.position, direction}, path.region, Rgb(1.0f), phase.pdf(vertex.before, direction)};
}

/// How a walk goes on. `Timed`: it has a clock. What it draws it takes from path.random by place (Draw).
template <typename S>
concept Steps = requires(S& steps, PathState& path, const Ahead& ahead, const WalkVertex& vertex) {
    { S::Timed } -> std::convertible_to<bool>;
    { steps.context() } -> std::convertible_to<WalkContext>;
    /// Traces the ray ahead, as far as anything can be of use.
    { steps.ahead(path) } -> std::same_as<Ahead>;
    /// Draws how the flight ends.
    { steps.flight(path, ahead) } -> std::same_as<Flight>;
    /// Light that the walk finds from the vertex on can still be in time.
    { steps.canArrive(path, vertex) } -> std::same_as<bool>;
    /// Roulette and splitting by nothing but the path so far: in how many copies the walk goes on, 0 if it ends. The
    /// throughput makes up for roulette; the loop shares it among the copies.
    { steps.copies(path, vertex) } -> std::same_as<int>;
    /// Draws the way on; none where the walk is absorbed.
    { steps.way(path, vertex) } -> std::same_as<std::optional<Way>>;
    /// Roulette by the throughput once it includes the way's weight.
    { steps.survives(path) } -> std::same_as<bool>;
};

/// What is done on the way; VisitorBase does nothing. What returns false ends the walk.
template <typename V, typename S>
concept Visitor = requires(V& visitor, PathState& path, S& steps, const Ahead& ahead, const Flight& flight,
                           const WalkVertex& vertex, const Way& way) {
    /// What may be found by flying on can still count.
    { visitor.mayGoOn(path) } -> std::same_as<bool>;
    /// A flight starts: what it leaves on its whole length, what is looked up along it.
    { visitor.ahead(path, steps, ahead) } -> std::same_as<bool>;
    /// The scene is left; the throughput includes the way there.
    visitor.escape(path);
    /// At the flight's end, before anything scatters: light that is met, bounds in time, limits.
    { visitor.arrive(path, steps, ahead, flight) } -> std::same_as<bool>;
    /// Connections and deposits of the vertex, before its roulette.
    { visitor.vertex(path, steps, vertex) } -> std::same_as<bool>;
    /// Before `path` takes this way, which its roulette may still end.
    visitor.leave(path, steps, vertex, way);
    /// The last of a walk, and of each copy: nothing goes on.
    visitor.end(path);
};

struct VisitorBase {
    bool ahead(PathState&, auto&, const Ahead&) { return true; }
    void escape(PathState&) {}
    bool arrive(PathState&, auto&, const Ahead&, const Flight&) { return true; }
    bool vertex(PathState&, auto&, const WalkVertex&) { return true; }
    void leave(PathState&, auto&, const WalkVertex&, const Way&) {}
    void end(PathState&) {}
};

template <typename S, typename V>
requires Steps<S> && Visitor<V, S>
struct Walk {
    PathState path;
    S steps;
    V visitor;

    /// Flights and vertices, until something ends the walk.
    void run() {
        while (visitor.mayGoOn(path)) {
            steps.context().counters.step(steps.context().watch);
            const Ahead ahead = steps.ahead(path);
            if (!ahead.flies || !visitor.ahead(path, steps, ahead)) break;
            if (!arrive(ahead, steps.flight(path, ahead))) break;
        }
        visitor.end(path);
    }

    /// The flight's end: true if the walk goes on from there. A walk whose first way is given starts here.
    bool arrive(const Ahead& ahead, const Flight& flight) {
        if (flight.event == Flight::Event::Nothing) return false;
        path.throughput = path.throughput * flight.weight;
        if (flight.event == Flight::Event::Escape) {
            visitor.escape(path);
            return false;
        }
        if (isBlack(path.throughput)) return false;
        const Medium* scatters = flight.event == Flight::Event::Collision ? ahead.medium : nullptr;
        fly(flight, scatters, ahead);
        if (!visitor.arrive(path, steps, ahead, flight)) return false;
        if (scatters) return goOn({scatters, nullptr, path.ray.origin, path.ray.direction, path.region});
        const SurfaceInteraction surface = makeInteraction(scene(), *ahead.hit, path.ray.direction);
        return goOn({nullptr, &surface, path.ray.origin, path.ray.direction, path.region});
    }

  private:
    [[nodiscard]] const Scene& scene() const { return steps.context().scene; }

    /// From the vertex, in as many copies as the steps say.
    bool goOn(const WalkVertex& vertex) {
        if (!steps.canArrive(path, vertex) || !visitor.vertex(path, steps, vertex)) return false;
        // Copies have their own numbers; they share the throughput.
        const int copies = steps.copies(path, vertex);
        if (copies > 1) path.throughput = path.throughput / float(copies);
        for (int i = 1; i < copies; ++i) {
            Walk copy(*this);
            copy.path.random = path.random.copy(path.interactions, i);
            if (copy.leave(vertex))
                copy.run();
            else
                copy.visitor.end(copy.path);
        }
        return copies > 0 && leave(vertex);
    }

    /// To the vertex, where an interaction is counted: in the medium that scatters, or on the surface if it is null.
    void fly(const Flight& flight, const Medium* scatters, const Ahead& ahead) {
        if constexpr (S::Timed) path.time = path.timeAfter(flight.length);
        ++path.interactions;
        if (scatters) {
            steps.context().counters.scatter(*scatters);
            ++path.mediumScatters;
            ++path.inARow;
            path.timed = path.scattered = true; // here the camera's own segments are over
        } else {
            ++steps.context().counters.surfaceEvents;
            path.flights = path.inARow = 0;
        }
        path.ray = {scatters ? path.ray.at(flight.distance) : ahead.hit->position, path.ray.direction};
    }

    /// Leaves by a way that the steps draw; false if none goes on.
    bool leave(const WalkVertex& vertex) {
        const auto way = steps.way(path, vertex);
        if (!way) return false;
        if (vertex.surface) steps.context().counters.countLobe(way->lobe);
        visitor.leave(path, steps, vertex, *way);
        path.ray = way->ray;
        path.region = way->region;
        path.throughput = path.throughput * way->weight;
        if (!way->straight()) {
            using Kind = LastVertex::Kind;
            const bool smooth = vertex.medium || way->smooth();
            path.last = {vertex.medium ? Kind::Medium
                         : smooth      ? Kind::Surface
                                       : Kind::Specular,
                         vertex.position, way->pdf};
            if (smooth) path.timed = path.scattered = true;
        }
        return !isBlack(path.throughput) && steps.survives(path);
    }
};
template <typename S, typename V>
Walk(PathState, S, V) -> Walk<S, V>;

} // namespace tungsten::transport
