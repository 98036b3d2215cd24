#pragma once
// Steps by the scene's own distributions: free flights, phase functions, BSDFs, roulette by the throughput.

#include "transport/BounceLimits.h"
#include "transport/Roulette.h"
#include "transport/Walk.h"

namespace tungsten::transport {

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

} // namespace tungsten::transport
