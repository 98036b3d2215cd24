#include "photon/light/PhotonGuidance.h"

namespace tungsten::photon {

PhotonGuidance::PhotonGuidance(const Scene& scene, const transport::Policy& policy, const PhotonPlan& plan,
                               const ProgressToken& watch)
    : view_(scene.camera), sides_(view_.sides()), cameraMedium_(scene.cameraRegion.medium),
      camera_(scene.camera.position()), speed_(double(plan.highestSpeed)),
      slack_(scene.transport.cameraUnwarped ? 0.0 : double(scene.camera.aperture()) / speed_),
      unwarped_(scene.transport.cameraUnwarped), directView_(plan.directView),
      drawsControlVertices_(policy.sampling.elliptical), storesPhotons_(plan.ordinaryPhotons.on),
      choosesFrames_(plan.framesOneByOne.on), drawsByResponse_(plan.drawsByResponse),
      meetsDeltaGate_(plan.meetsDeltaGate), darkFrames_(plan.framesOneByOne.on ? plan.darkFrames : 0),
      sensor_(transport::Sensor::of(scene, scene.transport.gate)) {
    if (!unwarped_) waysOut_ = transport::WaysOut::make(scene, policy);
    if (policy.followsBodies()) bodies_ = transport::spheresAboutBodies(scene);
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
        if (unwarped_ || (!plan.mediaOutOfTime.empty() && plan.mediaOutOfTime[i])) {
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

darts::Residual PhotonGuidance::residual(const transport::Start& start, const Region& region, double elapsed,
                                         const darts::TimeGate& gate, uint64_t& rays) const {
    const auto range = darts::ResidualRange::of(gate, elapsed, speed_);
    if (unwarped_) return darts::Residual::withoutTarget(range);
    darts::Residual residual = darts::Residual::of(darts::vec3(camera_ - start.position), range);
    if (!waysOut_ || !residual.alive()) return residual;
    waysOut_->look(start, region, {camera_, cameraMedium_, {}, &sides_}, residual, rays);
    // Ranges are of the highest speed.
    const double slower = double(region.speed) / speed_;
    residual.exit.gate *= float(slower);
    if (residual.exit.connects) residual.exit.surplus = float((1.0 - slower) * range.high);
    return residual;
}

} // namespace tungsten::photon
