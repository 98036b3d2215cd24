#include "photon/ArrivalTest.h"

#include "darts/Ellipse.h"

namespace tungsten::photon {

namespace {

/// Where the path from `position` along `direction` and then straight to `target` is `length` long; 0 if it always is
/// longer.
double distanceOfLength(const Vec3d& position, const Vec3d& direction, const Vec3d& target, double length) {
    const Vec3d toTarget = target - position;
    const double distance = toTarget.length();
    if (!(length > distance)) return 0.0;
    const double h = distance > 0.0 ? 0.5 * (direction - toTarget / distance).length2() : 0.0;
    return darts::Ellipse<double>{distance, length - distance, h}.firstLeg();
}

} // namespace

ArrivalTest::ArrivalTest(const Scene& scene, const EffectPlan& plan)
    : sensor_(Sensor::of(scene, scene.transport.gate)), unwarped_(scene.transport.cameraUnwarped),
      highestSpeed_(double(plan.highestSpeed)) {
    const Vec3f position = scene.camera.position();
    camera_ = Vec3d(position.x, position.y, position.z);
    straightTimesKnown_ = !sensor_.gate.steadyState && scene.camera.hasSinglePosition() && !plan.speedsDiffer;
    directView_ = straightTimesKnown_ && !plan.specularSensorPaths;
    if (const auto* lens = std::get_if<ThinLens>(&scene.camera.model)) slack_ = double(lens->apertureRadius);
    if (std::holds_alternative<Orthographic>(scene.camera.model)) slack_ = std::numeric_limits<double>::infinity();
}

double ArrivalTest::soonestArrival(const Vec3f& position, double time) const {
    if (unwarped_) return time;
    const double distance = (Vec3d(position.x, position.y, position.z) - camera_).length();
    return time + std::max(distance - slack_, 0.0) / highestSpeed_;
}

bool ArrivalTest::insideGate(double arrival, bool testStart) const {
    // Rounding at the gate's ends must not lose what the gather would accept.
    const double tolerance = 1e-6 * std::abs(arrival);
    if (!(arrival < sensor_.gate.end() + tolerance)) return false;
    if (!testStart) return true;
    return arrival >= sensor_.gate.start - tolerance && sensor_.mayWeigh(arrival - tolerance, arrival + tolerance);
}

bool ArrivalTest::mayCount(const Vec3f& position, double time) const {
    return sensor_.gate.steadyState || insideGate(soonestArrival(position, time), directView_ || unwarped_);
}

bool ArrivalTest::seenStraight(const Vec3f& position, double time) const {
    return insideGate(soonestArrival(position, time), true);
}

FlightPart ArrivalTest::part(const Vec3f& position, const Vec3f& direction, double time, double speed,
                             bool testStart) const {
    if (sensor_.gate.steadyState) return {0.0, std::numeric_limits<double>::infinity()};
    const double tolerance = 1e-6 * std::abs(sensor_.gate.end());
    const double untilStart = sensor_.gate.start - tolerance - time, untilEnd = sensor_.gate.end() + tolerance - time;
    if (unwarped_) return {std::max(untilStart * speed, 0.0), untilEnd * speed};
    const Vec3d from(position.x, position.y, position.z), along(direction.x, direction.y, direction.z);
    const auto distance = [&](double duration) {
        return distanceOfLength(from, along, camera_, duration * highestSpeed_ + slack_);
    };
    // The flight alone ends it where the way to the camera is unknown, and where it is slower than the highest speed.
    const double end = std::isinf(slack_) ? untilEnd * speed : std::min(distance(untilEnd), untilEnd * speed);
    return {testStart ? distance(untilStart) : 0.0, end};
}

FlightPart ArrivalTest::countingPart(const Vec3f& position, const Vec3f& direction, double time, double speed) const {
    return part(position, direction, time, speed, directView_);
}

FlightPart ArrivalTest::straightPart(const Vec3f& position, const Vec3f& direction, double time, double speed) const {
    return part(position, direction, time, speed, true);
}

bool ArrivalTest::mayContinue(const Vec3f& position, double time) const {
    return sensor_.gate.steadyState || soonestArrival(position, time) < sensor_.gate.end();
}

} // namespace tungsten::photon
