#pragma once
// Steps by the scene's own distributions: free flights, phase functions, BSDFs, roulette by the throughput; or straight
// through media from surface to surface.

#include "transport/BounceLimits.h"
#include "transport/Tuning.h"
#include "transport/Walk.h"

#include "tungsten/core/Random.h"

namespace tungsten::transport {

/// Probability of going on; `throughput` relative to that of the path's start.
inline float survivalByThroughput(const Rgb& throughput, int interactions) {
    const float survival = maxComponent(throughput);
    return interactions < tuning::RouletteFirstInteraction || survival >= tuning::RouletteThreshold ? 1.0f : survival;
}

/// False ends the path; else the throughput, relative to that of the path's start, makes up for those that ended.
inline bool survivesRoulette(Rgb& throughput, int interactions, Sampler& sampler) {
    const float survival = survivalByThroughput(throughput, interactions);
    if (survival == 1.0f) return true;
    if (sampler.next1D() >= survival) return false;
    throughput = throughput / survival;
    return true;
}

/// Keeps what a path is worth for its cost near 1, by splitting and roulette: nothing is done from a half on, and up to
/// twice that. Whatever worth is given, images are the same.
class Splitting {
  public:
    /// In how many copies the path goes on, at most `most` at once. `split` is what a path of its throughput is worth
    /// to splitting, and `survival` to roulette, which draws a number of its own.
    int copies(PathState& path, float split, float survival, Draw draw, int most) {
        if (split > 2.0f && splits_ < MostSplits) {
            ++splits_;
            return split < float(most) ? int(split) : most;
        }
        if (!(survival < 0.5f)) return 1;
        path.random.at(path.interactions, draw);
        if (!(path.random.next1D() < survival)) return 0;
        path.throughput = path.throughput / survival;
        return 1;
    }

  private:
    /// Copies run within each other: a bound on the stack, which paths of a million bounces to and fro would meet.
    static constexpr int MostSplits = 1000;

    int splits_ = 0; ///< of the path and those that it is a copy of
};

/// Chosen when compiled.
struct PlainOptions {
    TransportMode mode = TransportMode::Radiance;
    bool media = true; ///< false: the scene has none
    bool timed = true;
    bool wholeRays = false; ///< flights are drawn up to the surface ahead, which the visitor wants to know in any case
};

template <PlainOptions Options>
class PlainSteps {
  public:
    static constexpr bool Timed = Options.timed;

    explicit PlainSteps(const WalkContext& context)
        : checks(context.scene.transport.consistencyChecks), context_(context) {}
    [[nodiscard]] const WalkContext& context() const { return context_; }

    Ahead ahead(PathState& path) {
        const Medium* medium = Options.media ? context_.scene.medium(path.region) : nullptr;
        if (medium) {
            if (medium->scatters() && !BounceLimits::fly(path.flights, *medium)) return {};
            context_.counters.fly(*medium);
            // The ray need not look beyond the collision.
            if (!Options.wholeRays) path.ray.tMax = draw(path, *medium, Infinity);
        }
        ++context_.counters.rays;
        return {true, medium, context_.scene.geometry->intersect(path.ray)};
    }

    Flight flight(PathState& path, const Ahead& ahead) {
        using Event = Flight::Event;
        const Event end = ahead.hit ? Event::Surface : Event::Escape;
        const float reach = ahead.reach();
        if (!Options.media || !ahead.medium) return {end, reach};
        if (Options.wholeRays) draw(path, *ahead.medium, reach);
        if (!Options.wholeRays && ahead.hit) drawn_ = flightThatExits(*ahead.medium, reach, path.channels);
        path.channels = drawn_.channels;
        return {drawn_.exited ? end : Event::Collision, drawn_.distance, drawn_.weight, drawn_.pdf};
    }

    bool canArrive(PathState&, const WalkVertex&) { return true; }
    int copies(PathState&, const WalkVertex&) { return 1; }

    std::optional<Way> way(PathState& path, const WalkVertex& vertex) {
        if (Options.media && vertex.medium) return sampleMediumWay(path, vertex);
        return sampleSurfaceWay(path, vertex, Options.mode, checks, lobes);
    }

    bool survives(PathState& path) {
        if (!roulette) return true;
        path.random.at(path.interactions, Draw::Roulette);
        return survivesRoulette(path.throughput, path.interactions, path.random);
    }

    bool roulette = false;
    bool checks;                ///< of directions against both normals (sampleSurfaceWay)
    LobeMask lobes = lobe::All; ///< that surfaces are left along

  private:
    float draw(PathState& path, const Medium& medium, float reach) {
        path.random.at(path.interactions + 1, Draw::Flight);
        drawn_ = sampleFlight(medium, reach, path.channels, path.random);
        return drawn_.distance;
    }

    WalkContext context_;
    FlightSample drawn_{}; ///< of the flight at hand
};

/// From lights.
using PlainLightSteps = PlainSteps<PlainOptions{.mode = TransportMode::Photons}>;

/// Straight through media, whatever they scatter, from surface to surface along the lobes that the visitor asks for.
template <TransportMode Mode>
class StraightSteps {
  public:
    static constexpr bool Timed = true;

    explicit StraightSteps(const WalkContext& context)
        : checks(context.scene.transport.consistencyChecks), context_(context) {}
    [[nodiscard]] const WalkContext& context() const { return context_; }

    Ahead ahead(PathState& path) {
        const Medium* medium = context_.scene.medium(path.region);
        if (medium) context_.counters.fly(*medium);
        ++context_.counters.rays;
        return {true, medium, context_.scene.geometry->intersect(path.ray)};
    }
    Flight flight(PathState&, const Ahead& ahead) {
        Flight flight{ahead.hit ? Flight::Event::Surface : Flight::Event::Escape, ahead.reach()};
        if (ahead.medium && attenuated) flight.weight = ahead.medium->transmittance(ahead.reach());
        return flight;
    }
    bool canArrive(PathState&, const WalkVertex&) { return true; }
    int copies(PathState&, const WalkVertex&) { return 1; }
    std::optional<Way> way(PathState& path, const WalkVertex& vertex) {
        return sampleSurfaceWay(path, vertex, Mode, checks, lobes);
    }
    bool survives(PathState&) { return true; }

    bool checks;            ///< of directions against both normals (sampleSurfaceWay)
    bool attenuated = true; ///< false: only when, and where, light gets
    LobeMask lobes = lobe::All;

  private:
    WalkContext context_;
};

} // namespace tungsten::transport
