#pragma once
// Steps of a light path that is aimed at the camera inside the time gate: guided distances and directions,
// roulette and splitting by expected contribution (He et al. 2024 and its successor presets; docs/method.md, sections 3
// to 6).

#include "photon/Tuning.h"
#include "photon/light/PhotonGuidance.h"

#include "transport/Balance.h"
#include "transport/BoundedMedium.h"
#include "transport/GuidedSteps.h"
#include "transport/Walk.h"

#include "darts/Vec3.h"

#include "tungsten/emitter/Emitter.h"

#include <span>
#include <vector>

namespace tungsten::photon {

/// The emitter's cone of directions, of one that shines in more than a single direction. A share goes towards bodies of
/// fog that are small from there, each as much as the other.
class EmissionDirections {
  public:
    EmissionDirections(const Emitter& emitter, const SurfaceSample& start,
                       std::span<const transport::MediumSphere> bodies = {}) {
        const EmissionCone cone = emissionCone(emitter, start);
        axis_ = darts::vec3(cone.axis);
        widest_ = cone.widest;
        cosine_ = cone.cosineWeighted;
        for (const transport::MediumSphere& body : bodies) addCone(start.position, body);
        if (!cones_.empty()) share_ = tuning::TowardsBodies;
    }
    [[nodiscard]] darts::Vec3 sample(float u, float v) const {
        if (u < share_) {
            const float scaled = u / share_ * float(cones_.size());
            const size_t chosen = std::min(size_t(scaled), cones_.size() - 1);
            return darts::directionAbout(cones_[chosen].axis, (scaled - float(chosen)) * cones_[chosen].widest, v);
        }
        const float rest = (u - share_) / (1.0f - share_);
        // sin^2 is uniform for the cosine: with x for it, h = 1 - sqrt(1 - x) = x / (1 + sqrt(1 - x)).
        const float x = rest * sineSquared();
        return darts::directionAbout(axis_, cosine_ ? x / (1.0f + std::sqrt(1.0f - x)) : widest_ * rest, v);
    }
    /// Above 0 for whatever sample() draws.
    [[nodiscard]] float pdf(const darts::Vec3& direction) const {
        const float h = darts::oneMinusCosine(direction, axis_);
        float own = uniform(h, widest_);
        if (cosine_ && own > 0.0f) own = std::max(1.0f - h, LeastCosine) / (darts::Pi * sineSquared());
        if (cones_.empty()) return own;
        float towards = 0.0f;
        for (const Cone& cone : cones_) towards += uniform(darts::oneMinusCosine(direction, cone.axis), cone.widest);
        return (1.0f - share_) * own + share_ * towards / float(cones_.size());
    }

  private:
    static constexpr float Rounding = 1e-6f, LeastCosine = 1e-6f;

    struct Cone {
        darts::Vec3 axis;
        float widest; ///< largest 1 - cos
    };

    /// Squared sine of the cone's half angle.
    [[nodiscard]] float sineSquared() const { return widest_ * (2.0f - widest_); }
    /// Rounding carries directions across a cone's edge, by as much as it moves their difference from the axis. Beyond
    /// the emitter's own edge nothing is emitted, so that the density there does not matter.
    [[nodiscard]] static float uniform(float h, float widest) {
        const float edge = widest + Rounding * std::sqrt(widest);
        return h <= edge ? 1.0f / (2.0f * darts::Pi * widest) : 0.0f;
    }
    void addCone(const Vec3f& position, const transport::MediumSphere& body) {
        const Vec3f offset = body.centre - position;
        const float distance = offset.length();
        if (!(distance > body.radius)) return;
        const darts::Vec3 axis = darts::vec3(offset / distance);
        const float sine = body.radius / distance, widest = sine * sine / (1.0f + std::sqrt(1.0f - sine * sine));
        // Half of what the emitter lights, or more, needs no help.
        if (widest > 0.5f * widest_) return;
        const auto angle = [](float h) { return std::acos(std::clamp(1.0f - h, -1.0f, 1.0f)); };
        if (angle(darts::oneMinusCosine(axis, axis_)) < angle(widest_) + angle(widest))
            cones_.push_back({axis, widest});
    }

    darts::Vec3 axis_;
    float widest_; ///< largest 1 - cos
    bool cosine_;
    std::vector<Cone> cones_;
    float share_ = 0.0f;
};

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
