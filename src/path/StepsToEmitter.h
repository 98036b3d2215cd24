#pragma once
// Steps of a camera path that is guided towards one target (docs/method.md, sections 3 to 6): resampled distances and
// directions in media and from surfaces that reflect smoothly, elsewhere as the scene has them.

#include "path/ArrivalBound.h"
#include "path/PathSettings.h"
#include "path/PathTarget.h"
#include "path/techniques/ShellChord.h"

#include "transport/Balance.h"
#include "transport/GuidedSteps.h"
#include "transport/TimeSensor.h"
#include "transport/TimeWindows.h"
#include "transport/Walk.h"

#include "darts/Guide.h"

#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/integrator/SceneFacts.h"
#include "tungsten/scene/Scene.h"

#include <algorithm>
#include <vector>

namespace tungsten::path {

/// How guided camera paths sample in each medium, and from surfaces before it.
struct PathGuides {
    /// `plan`: media that light is out of time in are not guided in.
    static PathGuides of(const Scene& scene, const transport::Policy& policy, const SceneFacts& facts,
                         const ProgressToken& watch);

    std::vector<darts::Guide> media;   ///< for flights, and for leaving scatterers
    std::vector<darts::Guide> diffuse; ///< for leaving surfaces into it
    std::vector<darts::Guide> glossy;  ///< for leaving surfaces without diffuse lobes

    /// Number of tables of directions in use: one for every medium that has one.
    [[nodiscard]] size_t tables() const {
        return size_t(std::count_if(media.begin(), media.end(), [](const darts::Guide& guide) {
            return guide.settings().direction == darts::Direction::Eda;
        }));
    }
};

class LightCaches;

/// Surfaces that light may be followed to: all lobes smooth, none transmits.
bool endsGlossySubpath(LobeMask lobes);

/// What guided paths share.
struct GuidedContext {
    const Scene& scene;
    const PathSettings& settings;
    const transport::TimeSensor& sensor;
    const transport::TimeWindows& windows;
    const PathGuides& guides;
    const LightCaches& lightCaches;
    const ArrivalBound& bound;
    const transport::EscapeModels* escapeModels; ///< null: media are taken for infinite
    bool forwardBoundaries;                      ///< connections must look through index-matched surfaces
    const ProgressToken& watch;
    transport::StrategyBalance balance{};  ///< of guided paths beside plain ones
    const TargetChoice* targets = nullptr; ///< paths choose among their emitter's points; null: they do not
};

class StepsToEmitter : public transport::GuidedSteps {
  public:
    static constexpr bool Timed = true;

    /// Light of the target is looked for in this window of time.
    StepsToEmitter(const GuidedContext& guided, PathCounters& counters, const PathTarget& target, size_t window = 0)
        : context_{guided.scene, counters, guided.watch}, guided_(&guided), target_(target), window_(window),
          choosesPoint_(guided.targets && guided.escapeModels && guided.targets->hasOtherPoints(target)) {}
    [[nodiscard]] const transport::WalkContext& context() const { return context_; }

    transport::Ahead ahead(PathState& path) { return ahead(path, Asks::Path, nullptr); }
    transport::Flight flight(PathState& path, const transport::Ahead& ahead);
    bool canArrive(PathState& path, const transport::WalkVertex& vertex);
    int copies(PathState& path, const transport::WalkVertex& vertex);
    std::optional<transport::Way> way(PathState& path, const transport::WalkVertex& vertex);
    bool survives(PathState& path);

    // These answer for a plain path (PlainTrail) how densely guided ones would have gone where it went. `path` has the
    // throughput that a guided path would have there.
    /// ahead(), where the target's point has been chosen, and the surface that ends the flight may be known.
    transport::Ahead ahead(PathState& path, const SurfaceHit* known) { return ahead(path, Asks::Density, known); }
    [[nodiscard]] bool hasDensities() const { return guided_->balance.both(); }
    /// What copies() is on the average, without drawing.
    float expectedCopies(const PathState& path, const transport::WalkVertex& vertex);
    /// way(), for the direction in which a plain path left: adds to the path's logRatio.
    void leaveAlong(PathState& path, const transport::WalkVertex& vertex, const transport::Way& way);

    // Logarithms of densities, guided over plain, for the flight at hand and for paths that end on it:
    /// Own vertices that connect, control vertices that are traced.
    [[nodiscard]] InMedium inMedium(float distance) const;
    /// The same where control vertices have a density that is known.
    [[nodiscard]] InMedium inMedium(float distance, float control) const;
    /// Own vertices in the medium at hand connect; elsewhere control vertices bring all of that light.
    [[nodiscard]] bool ownVerticesConnect() const {
        return passage_ != Passage::Medium || budget().model != darts::EscapeModel::Infinite ||
               !guided_->bound.oneSpeed() || !drawsControlVertices();
    }
    /// A path whose last vertex is the surface ahead, which guided paths see whether or not they go there.
    [[nodiscard]] float logRatioOnSurface() const;
    /// A plain path's way up to the end of its flight.
    [[nodiscard]] float logRatioThere(const transport::Flight& flight) const;
    /// Per length, of control vertices that are traced, and of the path's own vertices.
    [[nodiscard]] float controlVertexDensity(float distance) const;
    [[nodiscard]] float vertexDensity(float distance) const;
    /// The probability that a control vertex there is traced; `onward` is the direction of its connection.
    [[nodiscard]] float shadowRayProbability(const darts::ControlVertex& vertex, const Vec3f& onward) const;
    /// Where control vertices of a flight that takes no time may be.
    [[nodiscard]] ShellChord controlChord(const Ray& ray, const Region& region, float surface) const;

    [[nodiscard]] const PathTarget& target() const { return target_; }
    /// How much denser guided paths connect a vertex in a medium than plain ones, with so much in all, and both
    /// together than plain paths alone. The choice among points is left out: it is not a function of the path.
    [[nodiscard]] float connectionsOverPlain(float logRatio) const {
        return guided_->balance.overPlain(logRatio - logOfPoint_ + std::log(window().probability));
    }
    [[nodiscard]] const transport::TimeWindow& window() const { return guided_->windows[window_]; }
    [[nodiscard]] const darts::Guide& guideOf(const Region& region) const {
        return guided_->guides.media[size_t(region.medium)];
    }
    /// Whether flights have control vertices.
    [[nodiscard]] bool drawsControlVertices() const { return guided_->settings.policy.sampling.elliptical; }
    /// The guide of the medium before a surface all of whose lobes are smooth and reflect; none elsewhere. `back` is
    /// the way there, turned round, through `region`.
    [[nodiscard]] const darts::Guide* guideFor(const transport::Vertex& vertex, const Vec3f& back,
                                               const Region& region) const;
    /// Guide of the surface that the path is at.
    [[nodiscard]] const darts::Guide* surfaceGuide() const { return surfaceGuide_; }
    /// Draws the length of a connection from a vertex with this time budget; along a way, if `h` says which.
    [[nodiscard]] darts::ConnectionSample drawConnection(PathState& path, const darts::Guide& guide,
                                                         const darts::TimeBudget& budget,
                                                         const float* h = nullptr) const;

    /// Ordinary connections share with control vertices: in bodies that light must leave, whose directions do not
    /// follow the connections' weights so closely.
    [[nodiscard]] bool sharesConnections() const {
        return budget().model != darts::EscapeModel::Infinite && !guided_->sensor.gate.delta;
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
    enum class Asks { Path, Density };
    // What lies ahead.
    transport::Ahead ahead(PathState& path, Asks asks, const SurfaceHit* known);
    transport::Ahead aheadInEmpty(PathState& path, const Medium* medium, const SurfaceHit* known);
    transport::Ahead aheadInMedium(PathState& path, const Medium& medium, Asks asks, const SurfaceHit* known);
    /// Where light must get out of the medium ahead: the target becomes one of M points of its emitter
    /// (TargetChoice::otherPoint) by the light w that each may bring in time, or in one case of M stays. Density of the
    /// random numbers of the point: p(u) = 1 / M + (M - 1) w(u) / sum of w.
    void choosePoint(PathState& path, Asks asks);
    /// Logarithm of the light that the target may bring to the ray's origin in time.
    [[nodiscard]] float logImportanceOfTarget(const PathState& path);
    transport::Ahead aheadUntimed(PathState& path, const Medium& medium, const SurfaceHit* known);
    /// The surface ahead, up to the end of the ray.
    std::optional<SurfaceHit> see(const Ray& ray, const SurfaceHit* known);
    transport::Flight flyUntimed(PathState& path, const transport::Ahead& ahead);
    transport::Flight flyGuided(PathState& path, const transport::Ahead& ahead);
    /// Distances of a flight that takes no time: the surface by its transmittance; in the medium one from which light
    /// may still arrive, half of them by transmittance, half by angle.
    struct Untimed {
        /// `distance`: of the surface.
        Untimed(const Vec3f& toTarget, const Vec3f& direction, double reach, const Medium& medium, float distance);
        [[nodiscard]] double sample(double u, float half) const;
        [[nodiscard]] double pdf(double t) const; ///< per length

        ShellChord chord;     ///< in the medium
        float surface = 0.0f; ///< its probability

      private:
        [[nodiscard]] darts::ConnectionLength<double> flights() const {
            return {chord.begin(), chord.end() - chord.begin(), double(meanComponent(medium_->sigmaT()))};
        }
        const Medium* medium_;
    };
    [[nodiscard]] Untimed untimed(const Ray& ray, const Medium& medium, float distance) const;
    [[nodiscard]] float surfaceProbability() const;
    /// The flight at hand as plain paths have it.
    [[nodiscard]] transport::PlainFlight plain() const { return {medium_, reach_, start_.channels}; }

    /// What may still come from `position`, at the present time and in the present region.
    void setTimeBudgetFrom(const PathState& path, const Vec3f& position);
    /// How light gets from here to the target; once, before anything is sampled.
    void setEscapeModelFrom(const PathState& path, const transport::FlightStart& start);
    /// How many copies go on: with a probability, or as many.
    struct Onward {
        float survival = 1.0f;
        int copies = 1;
    };
    Onward onward(const PathState& path, const transport::WalkVertex& vertex);
    [[nodiscard]] darts::ResponseAt response(double time) const;
    [[nodiscard]] bool guidesSurface() const { return surfaceGuide_ && budget().alive(); }

    transport::Way leaveMedium(PathState& path, const transport::WalkVertex& vertex);
    transport::Way leaveGuided(PathState& path, const transport::WalkVertex& vertex);
    std::optional<transport::Way> leavePlainly(PathState& path, const transport::WalkVertex& vertex);
    /// Draws the next direction, and before it, where the settings say so, the control vertex on it.
    template <typename Scatterer>
    darts::DirectionSample draw(PathState& path, const darts::Guide& guide, const Scatterer& scatterer);

    transport::WalkContext context_;
    const GuidedContext* guided_;
    PathTarget target_;
    size_t window_;
    float logOfPoint_ = 0.0f; ///< logarithm of how much likelier the choice among points has made the target
    bool choosesPoint_; ///< where a scattering medium is met first; until then no step asks where the target's point is
    bool startsAnew_ = true; ///< the ray ahead has not been looked along
    Passage passage_ = Passage::Empty;
    const darts::Guide* surfaceGuide_ = nullptr;
    // The flight at hand.
    darts::Heading heading_{};
    const Medium* medium_ = nullptr;
    float reach_ = 0.0f;                                      ///< of the surface ahead
    PathState start_{Sampler(0, RandomStream::Camera, 0, 0)}; ///< of the path, where it begins
    std::optional<darts::DistanceDensity> distances_;
};

} // namespace tungsten::path
