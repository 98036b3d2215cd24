#pragma once
// Steps of a light path that is aimed at the camera inside the time gate: resampled distances, guided directions,
// roulette and splitting by usefulness (He et al. 2024 and its successor presets; docs/method.md, sections 3 to 6).

#include "photon/light/FirstUsefulness.h"
#include "photon/light/PhotonGuidance.h"

#include "transport/GuidedSteps.h"
#include "transport/Walk.h"

namespace tungsten::photon {

/// What a pass tells the steps of its paths.
struct StepRules {
    bool storesVertices = false;            ///< of a primitive that is made at vertices
    const FirstUsefulness* first = nullptr; ///< in bodies that light must leave
    FirstUsefulness* measured = nullptr;    ///< of pilot paths, which end at their first vertex there
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

    transport::Ahead ahead(transport::PathState& path);
    transport::Flight flight(transport::PathState& path, const transport::Ahead& ahead);
    bool canArrive(transport::PathState& path, const transport::WalkVertex& vertex);
    int copies(transport::PathState& path, const transport::WalkVertex& vertex);
    std::optional<transport::Way> way(transport::PathState& path, const transport::WalkVertex& vertex);
    bool survives(transport::PathState&) { return true; }

    /// From a point of a light. 1 / density per solid angle of the direction; none if nothing can be in time.
    template <typename Emission>
    std::optional<float> emit(transport::PathState& path, const transport::Start& start, const Emission& directions,
                              Vec3f& direction) {
        if (!lookFrom(path, start)) return std::nullopt;
        return draw(path, *guidance_->guide(path.region), directions, direction);
    }

    // Of the flight at hand, through a medium that scatters.
    [[nodiscard]] const darts::Guide& guide() const { return *guide_; }
    /// `shares`: ordinary photons share with control vertices.
    [[nodiscard]] std::optional<OnWay> controlVertex(transport::PathState& path, const transport::Ahead& ahead,
                                                     bool shares);
    [[nodiscard]] const darts::TimeGate& gate() const { return gate_; }
    [[nodiscard]] const PhotonGuidance& guidance() const { return *guidance_; }

  private:
    /// False if nothing can be in time.
    bool lookFrom(const transport::PathState& path, const transport::Start& start);
    bool passesRoulette(transport::PathState& path, const darts::Guide& guide);
    /// Of a connection from a vertex with this residual.
    darts::ConnectionSample drawConnection(transport::PathState& path, const darts::Guide& guide,
                                           const darts::Residual& residual) const;
    /// The direction of the straight way ahead, and before it the length of the connection, where settings say so.
    template <typename Scatterer>
    std::optional<float> draw(transport::PathState& path, const darts::Guide& guide, const Scatterer& scatterer,
                              Vec3f& direction);

    transport::WalkContext context_;
    const PhotonGuidance* guidance_;
    StepRules rules_;
    darts::TimeGate gate_;
    const darts::Guide* guide_ = nullptr; ///< of the flight at hand; null where nothing scatters
    darts::Heading heading_{};
};

template <typename Scatterer>
std::optional<float> StepsToCamera::draw(transport::PathState& path, const darts::Guide& guide,
                                         const Scatterer& scatterer, Vec3f& direction) {
    if (guide.settings().lengthFirst) {
        path.random.at(path.interactions, Draw::Connection);
        const darts::ConnectionSample connection = drawConnection(path, guide, residual());
        connect(connection);
        // A density of 0: the response is over, or the delta gate, but surfaces may still be seen in its kernel.
        if (!(connection.inversePdf > 0.0f) && !guidance_->meetsDeltaGate()) return std::nullopt;
    }
    path.random.at(path.interactions, Draw::GuidedDirection);
    const auto random = [&] { return path.random.next1D(); };
    const darts::DirectionSample sample = sampleDirection(guide, scatterer, guidance_->view(), random);
    direction = darts::to<Vec3f>(sample.direction);
    return sample.inversePdf;
}

} // namespace tungsten::photon
