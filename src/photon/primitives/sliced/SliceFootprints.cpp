#include "photon/primitives/sliced/SliceFootprints.h"

#include "photon/primitives/beams/PhotonBeam.h"
#include "photon/primitives/sliced/CameraRay.h"

namespace tungsten::photon {

SliceFootprints::SliceFootprints(const Scene& scene, const transport::TimeSensor& sensor, double scale)
    : scene_(scene), gate_(sensor.gate), scale_(scale), warped_(!scene.transport.cameraUnwarped),
      delta_(scene.transport.gate.delta), weighed_(sensor.response != nullptr) {
    if (scene.camera.hasSinglePosition()) footprint_.emplace(scene.camera);
}

std::optional<ImageSlice> SliceFootprints::prepare(const SliceRecord& flights, std::span<const float> shares) const {
    const Medium& medium = scene_.media[size_t(flights.medium)];
    const auto speed = double(medium.speedOfLight);
    const bool far = farAway(flights, speed);
    const float common =
        far && warped_ && !gate_.steadyState ? (scene_.camera.position() - flights.base).length() : 0.0f;
    LaneTimes times = timesOf(flights, speed, double(common));
    times.shares = shares;
    const float length = std::min(times.start(times.frames) + common, visibleReach(medium));
    if (!(length > 0.0f)) return std::nullopt;
    const auto area = areaOf(flights, length);
    if (!area) return std::nullopt;
    const bool ball = flights.shape == FlightShape::Ball, occluders = !scene_.primitives.empty();
    const auto& w = flights.directions;
    const auto light =
        flights.emitter >= 0 ? isotropicIntensity(scene_.emitters[size_t(flights.emitter)]) : std::optional<Rgb>();
    LaneRecord record{&flights,
                      times,
                      medium.sigmaT(),
                      medium.isGrey(),
                      warped_,
                      far,
                      common,
                      medium.phase.g(),
                      occluders ? flights.reach : Infinity,
                      occluders || flights.shared,
                      ball ? 0.0f : medium.phase.pdf(w[1], w[2]),
                      1.0f,
                      light.has_value()};
    if (ball) record.pdfs = pdfFlight(medium, flights.lengths[0]) * pdfFlight(medium, flights.lengths[1]);
    ImageSlice s{record, kernelOf(flights), *area, flights.power, false};
    s.inLanes = !weighed_ && medium.phase.isHenyeyGreenstein() && (flights.emitter < 0 || light);
    const double perLength = atLengths(flights) ? speed * gate_.frameWidth : 1.0;
    for (int k = 0; k < 3; ++k)
        s.power[k] *= float(scale_ * perLength * collisions(double(medium.sigmaS()[k]), flights.flights()));
    if (light) s.power = s.power * *light;
    return s;
}

bool SliceFootprints::farAway(const SliceRecord& flights, double speed) const {
    // Floats lose 1e-7 of the distance: a hundred-thousandth of what is left, a thousandth of a frame.
    constexpr double MostOfLeft = 32.0, MostOfFrame = 1e4;
    const auto distance = double((scene_.camera.position() - flights.base).length());
    if (gate_.steadyState) return distance > MostOfLeft * double(visibleReach(scene_.media[size_t(flights.medium)]));
    const double left = (gate_.end() - flights.time) * speed - (warped_ ? distance : 0.0);
    return distance > std::min(MostOfLeft * left, MostOfFrame * gate_.frameWidth * speed);
}

bool SliceFootprints::atLengths(const SliceRecord& flights) const {
    if (flights.shape == FlightShape::Hypervolume) return true;
    return delta_ && !flights.blurredInTime();
}

LaneTimes SliceFootprints::timesOf(const SliceRecord& flights, double speed, double common) const {
    if (gate_.steadyState) return {0.0f, std::numeric_limits<float>::max(), 1};
    if (delta_ && !flights.blurredInTime())
        return {float((scene_.transport.gate.start - flights.time) * speed - common), 0.0f, 1};
    return {float((gate_.start - flights.time) * speed - common), float(gate_.frameWidth * speed), gate_.frames};
}

SliceKernel SliceFootprints::kernelOf(const SliceRecord& flights) const {
    if (flights.shape == FlightShape::Plane) return PlaneLanes(flights);
    if (flights.shape == FlightShape::Hypervolume) return HypervolumeLanes(flights);
    if (flights.shape == FlightShape::Volume)
        return atLengths(flights) ? SliceKernel(VolumeSliceLanes(flights)) : SliceKernel(VolumeChordLanes(flights));
    return atLengths(flights) ? SliceKernel(BallSliceLanes()) : SliceKernel(BallGateLanes());
}

std::optional<PixelArea> SliceFootprints::areaOf(const SliceRecord& flights, float length) const {
    const Vec2i resolution = scene_.camera.resolution;
    const PixelArea all{0, resolution.x - 1, 0, resolution.y - 1};
    if (!footprint_) return all;
    if (flights.shape == FlightShape::Ball) {
        const auto area = footprint_->around(flights.base, 1.0001f * length);
        return area;
    }
    std::array<Vec3f, 5> points;
    points[0] = flights.base;
    const auto count = size_t(flights.flights());
    for (size_t i = 0; i < count; ++i) points[i + 1] = flights.base + flights.directions[i] * length;
    // An unwarped slice is the triangle alone.
    const bool triangle = delta_ && !warped_ && flights.shape == FlightShape::Volume;
    return footprint_->aroundHull(std::span(points).subspan(triangle ? 1 : 0, count + (triangle ? 0 : 1)));
}

} // namespace tungsten::photon
