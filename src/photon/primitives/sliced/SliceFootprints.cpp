#include "photon/primitives/sliced/SliceFootprints.h"

#include "photon/primitives/beams/PhotonBeam.h"
#include "photon/primitives/sliced/SightLine.h"

namespace tungsten::photon {

SliceFootprints::SliceFootprints(const Scene& scene, const TimeGate& gate, double scale)
    : scene_(scene), gate_(gate), scale_(scale), warped_(!scene.transport.cameraUnwarped),
      delta_(scene.transport.gate.delta) {
    if (scene.camera.hasSinglePosition()) footprint_.emplace(scene.camera);
}

std::optional<ImageSlice> SliceFootprints::prepare(const CollapsedFlights& flights) const {
    const Medium& medium = scene_.media[size_t(flights.medium)];
    const TimeGate& gate = gate_;
    const bool blurred = delta_ && flights.blurredInTime();
    const double until = delta_ && !blurred ? scene_.transport.gate.start : gate.end();
    const double left = gate.steadyState ? std::numeric_limits<double>::infinity()
                                         : (until - flights.time) * double(medium.speedOfLight);
    const float length = float(std::min(left, double(visibleReach(medium))));
    if (!(length > 0.0f)) return std::nullopt;
    const auto area = areaOf(flights, length);
    if (!area) return std::nullopt;
    const bool ball = flights.shape == FlightShape::Ball;
    const auto& w = flights.directions;
    const PointEmitter* light =
        flights.emitter >= 0 ? std::get_if<PointEmitter>(&scene_.emitters[size_t(flights.emitter)].model) : nullptr;
    ImageSlice s{{&flights, VolumeLanes({w[0], w[1], w[2]}), medium.phase.g(), medium.sigmaT().x,
                  ball ? 0.0f : medium.phase.pdf(w[1], w[2]), 1.0f, light != nullptr},
                 *area,
                 float(left),
                 flights.power,
                 blurred ? float(gate.frameWidth * double(medium.speedOfLight)) : 0.0f,
                 ball,
                 false};
    s.inLanes = delta_ && (ball || flights.shape == FlightShape::Volume) && (flights.emitter < 0 || light) &&
                medium.isGrey() && !std::holds_alternative<Rayleigh>(medium.phase.model);
    const double sigmaS = double(medium.sigmaS().x);
    s.power = flights.power *
              float(scale_ * double(medium.speedOfLight) * gate.frameWidth * collisions(sigmaS, flights.flights()));
    if (light) s.power = s.power * light->intensity;
    if (ball) s.record.pdfs = pdfFlight(medium, flights.lengths[0]) * pdfFlight(medium, flights.lengths[1]);
    return s;
}

std::optional<PixelArea> SliceFootprints::areaOf(const CollapsedFlights& flights, float length) const {
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
