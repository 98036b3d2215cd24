#include "photon/ArrivalTest.h"

namespace tungsten::photon {

namespace {

double highestSpeed(const Scene& scene) {
    float speed = std::max(scene.transport.vacuumSpeed, scene.cameraRegion.speed);
    for (const Medium& medium : scene.media) speed = std::max(speed, medium.speedOfLight);
    for (const Primitive& primitive : scene.primitives)
        if (primitive.boundsRegion) speed = std::max({speed, primitive.inside.speed, primitive.outside.speed});
    return double(speed);
}

} // namespace

ArrivalTest::ArrivalTest(const Scene& scene, const EffectPlan& plan)
    : gate_(scene.transport.gate), unwarped_(scene.transport.cameraUnwarped), highestSpeed_(highestSpeed(scene)) {
    const Vec3f position = scene.camera.position();
    camera_ = Vec3d(position.x, position.y, position.z);
    directView_ = scene.camera.hasSinglePosition() && !plan.specularSensorPaths && !plan.speedsDiffer;
    if (const auto* lens = std::get_if<ThinLens>(&scene.camera.model)) slack_ = double(lens->apertureRadius);
    if (std::holds_alternative<Orthographic>(scene.camera.model)) slack_ = std::numeric_limits<double>::infinity();
    // One speed everywhere that counts: the camera's own.
    if (directView_) highestSpeed_ = double(scene.cameraRegion.speed);
}

double ArrivalTest::soonestArrival(const Vec3f& position, double time) const {
    if (unwarped_) return time;
    const double distance = (Vec3d(position.x, position.y, position.z) - camera_).length();
    return time + std::max(distance - slack_, 0.0) / highestSpeed_;
}

bool ArrivalTest::mayCount(const Vec3f& position, double time) const {
    if (gate_.steadyState) return true;
    const double arrival = soonestArrival(position, time);
    // Rounding at the gate's ends must not lose what the gather would accept.
    const double tolerance = 1e-6 * std::max(std::abs(arrival), 1e-30);
    if (arrival >= gate_.end() + tolerance) return false;
    return !(directView_ || unwarped_) || arrival >= gate_.start - tolerance;
}

bool ArrivalTest::mayContinue(const Vec3f& position, double time) const {
    return gate_.steadyState || soonestArrival(position, time) < gate_.end();
}

} // namespace tungsten::photon
