#pragma once
// Steps of a light path that is aimed at the camera inside the time gate: guided distances and directions,
// roulette and splitting by expected contribution (He et al. 2024 and its successor presets; docs/method.md, sections 3
// to 6).

#include "photon/light/EmissionDirections.h"
#include "photon/light/PhotonGuidance.h"

#include "transport/GuidedSteps.h"
#include "transport/Balance.h"
#include "transport/Walk.h"

namespace tungsten::photon {

/// What a pass tells the steps of its paths.
struct StepRules {
    bool storesVertices = false;          ///< of a primitive that is made at vertices
    transport::StrategyBalance balance{}; ///< of guided paths beside plain ones
};

/// In media that scatter; elsewhere straight on, and from surfaces by their BSDF.
class StepsToCamera : public transport::GuidedSteps {
  public:
    static constexpr bool Timed = true;

    /// `gate`: that light is to arrive in.
    StepsToCamera(const transport::WalkContext& context, const PhotonGuidance& guidance, const StepRules& rules,
                  const darts::TimeGate& gate)
        : context_(context), guidance_(&guidance), rules_(rules), gate_(gate) {}
    [[nodiscard]] const transport::WalkContext& context() const { return context_; }

    transport::Ahead ahead(transport::PathState& path) { return ahead(path, nullptr); }
    transport::Flight flight(transport::PathState& path, const transport::Ahead& ahead);
    bool canArrive(transport::PathState& path, const transport::WalkVertex& vertex);
    int copies(transport::PathState& path, const transport::WalkVertex& vertex);
    std::optional<transport::Way> way(transport::PathState& path, const transport::WalkVertex& vertex);
    bool survives(transport::PathState&) { return true; }

    /// From a point of a light that shines in more than a single direction; none if nothing can be in time.
    std::optional<transport::Way> emit(transport::PathState& path, const Emitter& emitter, const SurfaceSample& start);

    // These answer for a plain path (PhotonTrail) how densely guided ones would have gone where it went. `path` has the
    // throughput that a guided path would have there. All add to the path's logRatio, and draw nothing.
    /// emit(), in the direction that the plain path took. False if guided ones do not start.
    bool emitAlong(transport::PathState& path, const Emitter& emitter, const SurfaceSample& start,
                   const Vec3f& direction);
    /// ahead(), where the surface that ends the ray is known, or that there is none.
    transport::Ahead ahead(transport::PathState& path, const std::optional<SurfaceHit>* known);
    /// copies(), on the average.
    void copyAlong(transport::PathState& path, const transport::WalkVertex& vertex);
    void leaveAlong(transport::PathState& path, const transport::WalkVertex& vertex, const transport::Way& way);
    [[nodiscard]] bool hasDensities() const { return rules_.balance.both(); }

    // The flight at hand:
    [[nodiscard]] const darts::Guide& guide() const { return *guide_; } ///< through a medium that scatters
    /// `shares`: ordinary photons share with control vertices.
    [[nodiscard]] std::optional<OnWay> controlVertex(transport::PathState& path, const transport::Ahead& ahead,
                                                     bool shares);
    /// Densities of photons at this distance: of vertices, and of control vertices.
    [[nodiscard]] InMedium inMedium(float distance) const;
    /// Logarithm of the density of guided paths over that of the plain one, up to the end of its flight.
    [[nodiscard]] float logRatioThere(const transport::Flight& flight) const;

    [[nodiscard]] const darts::TimeGate& gate() const { return gate_; }
    [[nodiscard]] const PhotonGuidance& guidance() const { return *guidance_; }

  private:
    /// False if nothing can be in time.
    bool setTimeBudgetFrom(const transport::PathState& path, const transport::FlightStart& start);
    bool passesRoulette(transport::PathState& path, const darts::Guide& guide);
    [[nodiscard]] float survival(const transport::PathState& path, const darts::Guide& guide) {
        return GuidedSteps::survival(guide, path.region.medium, meanComponent(path.throughput));
    }
    /// Guided directions from a light; null where they are its own, or towards bodies.
    [[nodiscard]] const darts::Guide* guideOfEmission(const Region& region) const;
    [[nodiscard]] EmissionDirections emission(const Emitter& emitter, const SurfaceSample& start, bool guided) const {
        // What is guided aims at the camera itself.
        return {emitter, start, guided ? std::span<const transport::MediumSphere>() : guidance_->bodies()};
    }
    /// Draws the length of a connection from a vertex with this time budget.
    darts::ConnectionSample drawConnection(transport::PathState& path, const darts::Guide& guide,
                                           const darts::TimeBudget& budget) const;
    /// The direction of the straight way ahead, and before it the length of the connection, where settings say so.
    template <typename Scatterer>
    std::optional<darts::DirectionSample> draw(transport::PathState& path, const darts::Guide& guide,
                                               const Scatterer& scatterer);
    /// Per solid angle, of directions that are drawn first.
    template <typename Scatterer>
    [[nodiscard]] float pdf(const darts::Guide& guide, const Scatterer& scatterer, const Vec3f& direction) const {
        return guide.pdfDirection(budget(), {}, darts::vec3(direction), scatterer);
    }
    /// The flight at hand as plain paths have it.
    [[nodiscard]] transport::PlainFlight plain() const { return {medium_, reach_, start_.channels}; }

    transport::WalkContext context_;
    const PhotonGuidance* guidance_;
    StepRules rules_;
    darts::TimeGate gate_;
    // The flight at hand.
    const darts::Guide* guide_ = nullptr; ///< null where nothing scatters
    darts::Heading heading_{};
    const Medium* medium_ = nullptr;
    float reach_ = 0.0f;                                                 ///< of the surface ahead
    transport::PathState start_{Sampler(0, RandomStream::Photon, 0, 0)}; ///< of the path, where it begins
    std::optional<darts::DistanceDensity> distances_;
};

} // namespace tungsten::photon
