#pragma once
// Steps straight through media, whatever they scatter, from surface to surface along the lobes that the visitor asks
// for.

#include "transport/PlainSteps.h"

namespace tungsten::transport {

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
