#include "photon/light/PhotonGuidance.h"

#include "transport/GuidancePlan.h"

namespace tungsten::photon {

CameraView::CameraView(const Camera& camera) : position_(camera.position()), frame_(camera.toWorld.rotation()) {
    const FieldOfView fov = camera.fieldOfView().value_or(FieldOfView());
    aperture_ = camera.aperture() * (1.0f + 1.0f / std::max(camera.focusDistance(), 1e-6f));
    const float width = float(camera.resolution.x), height = float(camera.resolution.y);
    const float halfWidth = 1.0f / fov.planeDistance, halfHeight = halfWidth * height / width;
    // Pixel centres lie inside the image; filters reach a little beyond, the thin lens is off by half a pixel.
    const float pixel = 2.0f * halfWidth / width, reach = (camera.filter.halfWidth() + 1.0f) * pixel;
    marginX_ = halfWidth + reach;
    marginY_ = halfHeight + reach;
    slantX_ = std::sqrt(1.0f + marginX_ * marginX_);
    slantY_ = std::sqrt(1.0f + marginY_ * marginY_);
}

std::array<Vec3f, 4> CameraView::sides() const {
    const auto side = [&](const Vec3f& local) { return frame_.toWorld(local.normalized()); };
    return {side({1.0f, 0.0f, -marginX_}), side({-1.0f, 0.0f, -marginX_}), side({0.0f, 1.0f, -marginY_}),
            side({0.0f, -1.0f, -marginY_})};
}

bool CameraView::sees(const Vec3f& point, float radius) const {
    const Vec3f local = frame_.toLocal(point - position_);
    const float reach = radius + aperture_ * (1.0f + std::max(local.z, 0.0f));
    return local.z > -reach && std::abs(local.x) <= marginX_ * local.z + slantX_ * reach &&
           std::abs(local.y) <= marginY_ * local.z + slantY_ * reach;
}

FlightPart CameraView::seenPart(const Vec3f& origin, const Vec3f& direction, float radius) const {
    FlightPart part{0.0, std::numeric_limits<double>::infinity()};
    if (aperture_ > 0.0f) return part;
    const Vec3f from = frame_.toLocal(origin - position_), along = frame_.toLocal(direction);
    // value + s slope >= 0, a little wide against rounding.
    const auto clip = [&](double value, double slope) {
        value += 1e-5 * (std::abs(value) + double(radius));
        if (slope > 0.0) part.start = std::max(part.start, -value / slope);
        if (slope < 0.0) part.end = std::min(part.end, -value / slope);
        if (slope == 0.0 && value < 0.0) part.end = -1.0;
    };
    clip(double(from.z + radius), double(along.z));
    for (const float side : {-1.0f, 1.0f}) {
        clip(double(marginX_ * from.z + side * from.x + slantX_ * radius), double(marginX_ * along.z + side * along.x));
        clip(double(marginY_ * from.z + side * from.y + slantY_ * radius), double(marginY_ * along.z + side * along.y));
    }
    return part;
}

// ---- Guidance

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
        // Any place seen will do where time ends there, and none in time in what is excluded: nothing to aim at, only
        // the bound in time.
        const bool aims = !unwarped_ && (plan.excludedMedia.empty() || !plan.excludedMedia[i]);
        darts::Settings settings = transport::settingsIn(medium, policy, darts::Mode::Photon, aims);
        // On a delta gate directions suit the lengths that control vertices have there, not those of a kernel about it.
        if (meetsDeltaGate() && !policy.sampling.published) settings.lengthFirst = true;
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
