#pragma once
// Steps of a camera path that is guided towards one target (docs/method.md, sections 3 to 6): resampled distances and
// directions in media and from surfaces that reflect smoothly, elsewhere as the scene has them.

#include "path/ArrivalBound.h"
#include "path/PathSettings.h"
#include "path/PathTarget.h"

#include "transport/GuidedSteps.h"
#include "transport/Sensor.h"
#include "transport/Walk.h"

namespace tungsten::path {

class LightPaths;
class ShellChord;

/// Surfaces that light may be followed to: all lobes smooth, none transmits.
bool endsReflectedLight(LobeMask lobes);

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

/// What guided paths share.
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

class StepsToEmitter : public transport::GuidedSteps {
  public:
    static constexpr bool Timed = true;

    /// Where a path enters a body it may replace `target` by another point of its emitter.
    StepsToEmitter(const GuidedContext& guided, PathCounters& counters, PathTarget& target)
        : context_{guided.scene, counters, guided.watch}, guided_(&guided), counters_(&counters), target_(&target),
          choosesTarget_(guided.targets != nullptr) {}
    [[nodiscard]] const transport::WalkContext& context() const { return context_; }

    transport::Ahead ahead(PathState& path);
    transport::Flight flight(PathState& path, const transport::Ahead& ahead);
    bool canArrive(PathState& path, const transport::WalkVertex& vertex);
    int copies(PathState& path, const transport::WalkVertex& vertex);
    std::optional<transport::Way> way(PathState& path, const transport::WalkVertex& vertex);
    bool survives(PathState&) { return true; }

    [[nodiscard]] const PathTarget& target() const { return *target_; }
    [[nodiscard]] const darts::Guide& guideOf(const Region& region) const {
        const bool connects = residual().exit.connects;
        return (connects ? guided_->guides.media : guided_->guides.plain)[size_t(region.medium)];
    }
    /// The guide of the medium before a surface all of whose lobes are smooth and reflect; none elsewhere. `back` is
    /// the way there, turned round, through `region`.
    [[nodiscard]] const darts::Guide* guideFor(const transport::Vertex& vertex, const Vec3f& back,
                                               const Region& region) const;
    /// The same of the surface that the path is at.
    [[nodiscard]] const darts::Guide* surfaceGuide() const { return surfaceGuide_; }
    /// Of a connection from a vertex with this residual.
    [[nodiscard]] darts::ConnectionSample drawConnection(PathState& path, const darts::Guide& guide,
                                                         const darts::Residual& residual) const;

    /// Ordinary connections share with control vertices: in bodies that light must leave, whose directions do not
    /// follow the connections' weights so closely.
    [[nodiscard]] bool sharesConnections() const {
        return residual().way != darts::Way::Through && !guided_->sensor.gate.delta;
    }

    /// The flight at hand.
    enum class Passage {
        Empty,  ///< where nothing scatters
        Medium, ///< guided
        Untimed ///< guided, on a camera segment that does not count: time starts at the vertex
    };
    [[nodiscard]] Passage passage() const { return passage_; }
    [[nodiscard]] const darts::Heading& heading() const { return heading_; }

  private:
    // What lies ahead.
    transport::Ahead aheadInEmpty(PathState& path, const Medium* medium);
    transport::Ahead aheadInMedium(PathState& path, const Medium& medium);
    transport::Ahead aheadUntimed(PathState& path, const Medium& medium);
    transport::Flight flyUntimed(PathState& path, const transport::Ahead& ahead);

    /// What may still come from `position`, at the present time and in the present region.
    void lookAheadFrom(const PathState& path, const Vec3f& position);
    /// How light gets from here to the target; once, before anything is sampled.
    void lookOutFrom(const PathState& path, const transport::Start& start);
    /// A walk that enters a body chooses among points of its emitter by how much of their light gets out to it in time.
    void chooseTarget(PathState& path);
    /// The target's usefulness from the ray's origin, per area of its emitter; logarithm, NoUse if there is none.
    [[nodiscard]] float logUsefulTarget(const PathState& path);
    bool passesRoulette(PathState& path, const darts::Guide& guide);
    [[nodiscard]] bool guidesSurface() const { return surfaceGuide_ && residual().alive(); }

    transport::Way leaveMedium(PathState& path, const transport::WalkVertex& vertex);
    transport::Way leaveGuided(PathState& path, const transport::WalkVertex& vertex);
    std::optional<transport::Way> leavePlainly(PathState& path, const transport::WalkVertex& vertex);
    /// Draws the next direction, and before it, where the settings say so, the control vertex on it.
    template <typename Scatterer>
    darts::DirectionSample draw(PathState& path, const darts::Guide& guide, const Scatterer& scatterer);

    transport::WalkContext context_;
    const GuidedContext* guided_;
    PathCounters* counters_;
    PathTarget* target_;     ///< shared with copies: chosen before anything scatters, and so before splits
    bool choosesTarget_;     ///< until it is final
    bool startsAnew_ = true; ///< the ray ahead has not been looked along
    Passage passage_ = Passage::Empty;
    darts::Heading heading_{};
    const darts::Guide* surfaceGuide_ = nullptr;
};

} // namespace tungsten::path
