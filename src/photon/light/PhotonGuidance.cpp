#include "photon/light/PhotonGuidance.h"

namespace tungsten::photon {

PhotonGuidance::PhotonGuidance(const Scene& scene, const transport::Policy& policy, const PhotonPlan& plan,
                               const ProgressToken& watch)
    : view_(scene.camera), sides_(view_.sides()), cameraMedium_(scene.cameraRegion.medium),
      camera_(scene.camera.position()), speed_(double(plan.highestSpeed)),
      slack_(scene.transport.cameraUnwarped ? 0.0 : double(scene.camera.aperture()) / speed_),
      unwarped_(scene.transport.cameraUnwarped), directView_(plan.directView),
      drawsControlVertices_(policy.sampling.elliptical), storesPhotons_(plan.photonsWithControlVertices.on),
      choosesFrames_(plan.oneFramePerPath.on), drawsByResponse_(plan.drawsByResponse),
      meetsDeltaGate_(plan.meetsDeltaGate), darkFrames_(plan.oneFramePerPath.on ? plan.emptyFrames : 0),
      sensor_(transport::TimeSensor::of(scene, scene.transport.gate)) {
    if (!unwarped_) escapeModels_ = transport::EscapeModels::make(scene, policy);
    if (policy.followsBodies()) bodies_ = transport::spheresAboutMedia(scene);
    setGate(scene.transport.gate);
    watch.stage("guides of media", scene.media.size());
    for (size_t i = 0; i < scene.media.size(); ++i) {
        watch.advance();
        const Medium& medium = scene.media[i];
        guides_.emplace_back();
        if (!medium.scatters()) continue;
        darts::Settings settings =
            policy.sampling.settings(darts::Mode::Photon, medium.phase.g(), medium.guided, medium.guidedPhase);
        // On a delta gate directions suit the lengths that control vertices have there, not those of a kernel about it.
        if (meetsDeltaGate() && !policy.sampling.published) settings.lengthFirst = true;
        if (unwarped_ || (!plan.excludedMedia.empty() && plan.excludedMedia[i])) {
            // Any place seen will do, or none: nothing to aim at, only the bound in time.
            settings.direction = darts::Direction::Phase;
            settings.greens = darts::Greens::None;
        }
        guides_.back() = std::make_unique<darts::Guide>(
            settings, darts::Medium{darts::vec3(medium.sigmaA()), darts::vec3(medium.sigmaS()), medium.phase.g()});
    }
}

uint64_t PhotonGuidance::tables() const {
    return uint64_t(std::count_if(guides_.begin(), guides_.end(), [](const auto& guide) {
        return guide && guide->settings().direction == darts::Direction::Eda;
    }));
}

void PhotonGuidance::setGate(const TimeGate& gate) {
    frames_ = {gate.frameStart(darkFrames_), gate.frameWidth, gate.frames - darkFrames_};
    gate_ = {frames_.all().begin - slack_, frames_.all().end + slack_};
}

darts::TimeBudget PhotonGuidance::budget(const transport::FlightStart& start, const Region& region, double elapsed,
                                         const darts::TimeGate& gate, uint64_t& rays) const {
    const auto range = darts::LengthInterval::of(gate, elapsed, speed_);
    if (unwarped_) return darts::TimeBudget::withoutTarget(range);
    darts::TimeBudget budget = darts::TimeBudget::of(darts::vec3(camera_ - start.position), range);
    if (!escapeModels_ || !budget.alive()) return budget;
    escapeModels_->choose(start, region, {camera_, cameraMedium_, {}, &sides_}, budget, rays);
    // Ranges are of the highest speed.
    const double slower = double(region.speed) / speed_;
    budget.escape.gate *= float(slower);
    if (budget.escape.straightExit) budget.escape.extraLength = float((1.0 - slower) * range.high);
    return budget;
}

} // namespace tungsten::photon
