#include "photon/ArrivalTest.h"

namespace tungsten::photon {

ArrivalTest::ArrivalTest(const Scene& scene, const EffectPlan& plan)
    : gate_(scene.transport.gate), unwarped_(scene.transport.cameraUnwarped),
      highestSpeed_(double(highestSpeed(scene))) {
    const Vec3f position = scene.camera.position();
    camera_ = Vec3d(position.x, position.y, position.z);
    straightTimesKnown_ = !gate_.steadyState && scene.camera.hasSinglePosition() && !plan.speedsDiffer;
    directView_ = straightTimesKnown_ && !plan.specularSensorPaths;
    if (const auto* lens = std::get_if<ThinLens>(&scene.camera.model)) slack_ = double(lens->apertureRadius);
    if (std::holds_alternative<Orthographic>(scene.camera.model)) slack_ = std::numeric_limits<double>::infinity();
    // One speed everywhere that counts: the camera's own.
    if (straightTimesKnown_) highestSpeed_ = double(scene.cameraRegion.speed);
}

double ArrivalTest::soonestArrival(const Vec3f& position, double time) const {
    if (unwarped_) return time;
    const double distance = (Vec3d(position.x, position.y, position.z) - camera_).length();
    return time + std::max(distance - slack_, 0.0) / highestSpeed_;
}

bool ArrivalTest::insideGate(double arrival, bool testStart) const {
    // Rounding at the gate's ends must not lose what the gather would accept.
    const double tolerance = 1e-6 * std::abs(arrival);
    return arrival < gate_.end() + tolerance && (!testStart || arrival >= gate_.start - tolerance);
}

bool ArrivalTest::mayCount(const Vec3f& position, double time) const {
    return gate_.steadyState || insideGate(soonestArrival(position, time), directView_ || unwarped_);
}

bool ArrivalTest::seenStraight(const Vec3f& position, double time) const {
    return insideGate(soonestArrival(position, time), true);
}

bool ArrivalTest::mayContinue(const Vec3f& position, double time) const {
    return gate_.steadyState || soonestArrival(position, time) < gate_.end();
}

} // namespace tungsten::photon
