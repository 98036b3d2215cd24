#include "photon/store/ArrivalCulling.h"

#include "darts/Ellipse.h"

namespace tungsten::photon {

namespace {

/// Relative, of times of arrival.
constexpr double Tolerance = 1e-6;

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

ArrivalCulling::ArrivalCulling(const Scene& scene, const CameraSubpaths& paths)
    : sensor_(transport::TimeSensor::of(scene, scene.transport.gate)), unwarped_(scene.transport.cameraUnwarped),
      highestSpeed_(double(paths.highestSpeed)) {
    setGate(scene.transport.gate);
    const Vec3f position = scene.camera.position();
    camera_ = Vec3d(position.x, position.y, position.z);
    straightTimesKnown_ = !sensor_.gate.steadyState && scene.camera.hasSinglePosition() && paths.oneSpeed;
    directView_ = straightTimesKnown_ && !paths.redirected;
    slack_ = double(scene.camera.aperture());
    if (scene.camera.hasParallelRays()) slack_ = std::numeric_limits<double>::infinity();
}

void ArrivalCulling::setGate(const TimeGate& gate) {
    sensor_.gate = gate;
    // Rounding at the gate's ends must not lose what the gather would accept.
    begin_ = gate.start - Tolerance * std::abs(gate.end());
    end_ = gate.end() + Tolerance * std::abs(gate.end());
}

ArrivalCulling ArrivalCulling::ofFrame(int frame) const {
    ArrivalCulling test = *this;
    // The gather tests the sequence's ends; between frames there is no tolerance, or what is in it would count twice.
    if (frame > 0) test.begin_ = sensor_.gate.frameStart(frame);
    if (frame < sensor_.gate.frames - 1) test.end_ = sensor_.gate.frameStart(frame + 1);
    return test;
}

double ArrivalCulling::soonestArrival(const Vec3f& position, double time) const {
    if (unwarped_) return time;
    const double distance = (Vec3d(position.x, position.y, position.z) - camera_).length();
    return time + std::max(distance - slack_, 0.0) / highestSpeed_;
}

bool ArrivalCulling::insideGate(double arrival, bool testStart) const {
    if (!(arrival < end_)) return false;
    if (!testStart) return true;
    const double tolerance = Tolerance * std::abs(arrival);
    return arrival >= begin_ && sensor_.mayWeigh(arrival - tolerance, arrival + tolerance);
}

bool ArrivalCulling::mayCount(const Vec3f& position, double time) const {
    return sensor_.gate.steadyState || insideGate(soonestArrival(position, time), directView_ || unwarped_);
}

bool ArrivalCulling::seenStraight(const Vec3f& position, double time) const {
    return insideGate(soonestArrival(position, time), true);
}

FlightPart ArrivalCulling::part(const Vec3f& position, const Vec3f& direction, double time, double speed,
                                bool testStart) const {
    if (sensor_.gate.steadyState) return {0.0, std::numeric_limits<double>::infinity()};
    const double untilStart = begin_ - time, untilEnd = end_ - time;
    if (unwarped_) return {std::max(untilStart * speed, 0.0), untilEnd * speed};
    const Vec3d from(position.x, position.y, position.z), along(direction.x, direction.y, direction.z);
    // Where the arrival is that late. The flight alone says so where the way to the camera is unknown, and where it is
    // slower than the highest speed.
    const auto distance = [&](double duration) {
        const double flight = duration * speed;
        if (std::isinf(slack_)) return flight;
        return std::min(distanceOfLength(from, along, camera_, duration * highestSpeed_ + slack_), flight);
    };
    return {testStart ? std::max(distance(untilStart), 0.0) : 0.0, distance(untilEnd)};
}

FlightPart ArrivalCulling::countingPart(const Vec3f& position, const Vec3f& direction, double time,
                                        double speed) const {
    return part(position, direction, time, speed, directView_);
}

FlightPart ArrivalCulling::straightPart(const Vec3f& position, const Vec3f& direction, double time,
                                        double speed) const {
    return part(position, direction, time, speed, true);
}

bool ArrivalCulling::mayContinue(const Vec3f& position, double time) const {
    return sensor_.gate.steadyState || soonestArrival(position, time) < end_;
}

} // namespace tungsten::photon
