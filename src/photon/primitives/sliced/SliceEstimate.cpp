#include "photon/primitives/sliced/SliceEstimate.h"

#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/RaySliceQuery.h"
#include "photon/primitives/sliced/Volume.h"

namespace tungsten::photon {

namespace {

template <size_t K>
std::array<double, K> first(const std::array<double, 4>& all) {
    std::array<double, K> some;
    std::copy_n(all.begin(), K, some.begin());
    return some;
}

} // namespace

SliceEstimate::SliceEstimate(const Scene& scene, const transport::TimeSensor& sensor)
    : scene_(scene), sensor_(sensor), warped_(!scene.transport.cameraUnwarped), occluders_(!scene.primitives.empty()) {}

bool SliceEstimate::add(const SliceRecord& flights, const CameraSegment& segment, FrameSums& sums) const {
    const TransportSettings& transport = scene_.transport;
    if (flights.medium != segment.medium) return false;
    const int interactions = segment.interactions + flights.bounce + flights.flights();
    if (interactions < transport.minBounces || interactions >= transport.maxBounces) return false;
    const CameraRay<double> sight{Vec3d(segment.origin), Vec3d(segment.direction), 0.0, double(segment.length),
                                  warped_};
    const RaySliceQuery m{flights,
                          segment,
                          scene_.media[size_t(segment.medium)],
                          sight,
                          Vec3d(flights.base),
                          1.0 / segment.inverseSpeed,
                          flights.time + (warped_ ? segment.time : 0.0)};
    switch (flights.shape) {
    case FlightShape::Plane:
        return addPlane(m, sums);
    case FlightShape::Volume:
        return addVolume(m, sums);
    case FlightShape::Hypervolume:
        return eachSlice(
            m, [&](int frame, double time, double width) { return addHypervolume(m, frame, time, width, sums); });
    case FlightShape::Ball:
        return addBall(m, sums);
    case FlightShape::Beam:
        break;
    }
    return false;
}

bool SliceEstimate::deposit(const Vec3d& value, const Rgb& power, double factor, int frame, FrameSums& sums) {
    const Vec3d added = value * Vec3d(power) * factor;
    if (!(added.x + added.y + added.z > 0.0)) return false;
    sums[size_t(frame)] += added;
    return true;
}

bool SliceEstimate::unoccluded(const SliceRecord& flights, const double* lengths, int count) const {
    if (!occluders_) return true;
    if (lengths[0] >= double(flights.reach)) return false;
    Vec3d point = Vec3d(flights.base) + Vec3d(flights.directions[0]) * lengths[0];
    for (int i = 1; i < count; ++i) {
        const Vec3f& direction = flights.directions[size_t(i)];
        if (scene_.geometry->occluded(Ray{Vec3f(point), direction, 0.0f, float(lengths[i])})) return false;
        point += Vec3d(direction) * lengths[i];
    }
    return true;
}

bool SliceEstimate::addPlane(const RaySliceQuery& m, FrameSums& sums) const {
    const auto met = crossPlane(m.base, m.directions<2>(), m.sight);
    if (!met) return false;
    int frame = 0;
    double factor = m.phase(m.flights.directions[1]) * unended(m.flights, m.medium, met->lengths.data(), 2);
    if (!(factor > 0.0)) return false;
    if (!sensor_.gate.steadyState) {
        const double arrival = m.arrival(met->flightLength() + m.sight.warp() * met->alongRay);
        frame = sensor_.gate.frameOf(arrival);
        if (frame < 0) return false;
        factor *= double(sensor_.weight(arrival));
    }
    if (!unoccluded(m.flights, met->lengths.data(), 2)) return false;
    const Vec3d value = m.perChannel([&](const auto& medium) { return met->weight(medium); });
    return deposit(value, m.flights.power, factor, frame, sums);
}

bool SliceEstimate::addVolume(const RaySliceQuery& m, FrameSums& sums) const {
    if (!scene_.transport.gate.delta) return addVolumeChord(m, sums);
    return eachSlice(m,
                     [&](int frame, double time, double width) { return addVolumeSlice(m, frame, time, width, sums); });
}

bool SliceEstimate::addVolumeChord(const RaySliceQuery& m, FrameSums& sums) const {
    auto whole = volumeChord(m.base, m.directions<3>(), m.sight);
    if (!whole) return false;
    if (m.flights.shortFlights) whole->keepFlights(first<3>(flightEnds(m.flights, m.medium)));
    if (whole->empty()) return false;
    const double factor = m.phase(m.flights.directions[2]);
    if (sensor_.gate.steadyState) return addChord(m, *whole, 0, m.random(0, 0), factor, nullptr, sums);
    const TimeGate& gate = sensor_.gate;
    const double slope = whole->slopeSum() + m.sight.warp(), offset = whole->offsetSum();
    const double a = m.arrival(offset + slope * whole->start);
    const double b = std::isinf(whole->end) ? gate.end() : m.arrival(offset + slope * whole->end);
    bool any = false;
    for (int frame = gate.nearestFrame(std::min(a, b)); frame <= gate.nearestFrame(std::max(a, b)); ++frame) {
        auto chord = *whole;
        chord.keepGate({m.residual(gate.frameStart(frame)), m.residual(gate.frameStart(frame + 1))}, m.sight.warp());
        const ArrivalLine arrival{m.arrival(offset), slope / m.speed};
        any = addChord(m, chord, frame, m.random(0, frame), factor, &arrival, sums) || any;
    }
    return any;
}

SharedPath<double> SliceEstimate::sharedPath(const RaySliceQuery& m, const std::array<Vec3d, 3>& w,
                                             const std::array<double, 3>& lengths) const {
    const double pdfs = double(pdfFlight(m.medium, float(lengths[0]))) * double(pdfFlight(m.medium, float(lengths[1])));
    return {w, lengths[2], double(m.medium.phase.pdf(Vec3f(w[1]), Vec3f(w[2]))), pdfs};
}

double SliceEstimate::ratio(const RaySliceQuery& m, const std::array<Vec3d, 3>& w,
                            const std::array<double, 3>& lengths) const {
    return sharedPath(m, w, lengths).ratio(m.sight.direction, warped_);
}

double SliceEstimate::ratioInGate(const RaySliceQuery& m, const std::array<Vec3d, 3>& w,
                                  const std::array<double, 3>& lengths, double alongRay) const {
    if (sensor_.gate.frames > 1) return ratio(m, w, lengths);
    // A ball's base is where its last flight begins.
    const bool ball = m.flights.shape == FlightShape::Ball;
    const double before = ball ? lengths[0] + lengths[1] : 0.0;
    const Vec3d base = ball ? m.base - w[0] * lengths[0] - w[1] * lengths[1] : m.base;
    const ResidualGate<double> gate{m.residual(sensor_.gate.start) + before, m.residual(sensor_.gate.end()) + before};
    return sharedPath(m, w, lengths)
        .ratioInGate(base, lengths[0], lengths[1], alongRay, m.sight, gate, double(meanComponent(m.medium.sigmaT())));
}

template <size_t K>
bool SliceEstimate::addChord(const RaySliceQuery& m, const Chord<double, K>& chord, int frame, double u, double factor,
                             const ArrivalLine* arrival, FrameSums& sums) const {
    if (chord.empty()) return false;
    const double mean = double(meanComponent(m.medium.sigmaT())), ended = m.flights.shortFlights ? mean : 0.0;
    // The integrand is e^{-(first + fall t)}: of short flights it lacks what their ends stand for.
    const auto fallOf = [&](double sigmaT) { return sigmaT * (chord.slopeSum() + 1.0) - ended * chord.slopeSum(); };
    const auto firstOf = [&](double sigmaT) { return (sigmaT - ended) * chord.offsetSum(); };
    const auto integral = [&](double sigmaT) {
        return exponentialIntegral(1.0, firstOf(sigmaT), fallOf(sigmaT), chord.start, chord.end) / chord.jacobian;
    };
    if (occluders_ || m.flights.shared || (sensor_.response && arrival)) {
        // Drawn by the integrand of the mean coefficient; colours are weighed below.
        const double fall = fallOf(mean), length = chord.end - chord.start, z = fall * length;
        const double along = std::abs(z) < 1e-8 ? u * length : -std::log1p(u * std::expm1(-z)) / fall;
        const double t = std::min(chord.start + along, chord.end);
        std::array<double, K> lengths;
        for (size_t i = 0; i < K; ++i) lengths[i] = std::max(chord.length(i, t), 0.0);
        if (!unoccluded(m.flights, lengths.data(), int(K))) return false;
        if constexpr (K == 3) {
            if (m.flights.shared) factor *= volumeWeight(ratioInGate(m, m.directions<3>(), lengths, t));
        }
        if (arrival) factor *= double(sensor_.weight(arrival->offset + arrival->slope * t));
        if (!m.medium.isGrey()) {
            const double drawn = integral(mean) * std::exp(firstOf(mean) + fall * t);
            const Vec3d value = m.perChannel([&](const auto& c) {
                return collisions(c.sigmaS, int(K)) * drawn * std::exp(-firstOf(c.sigmaT) - fallOf(c.sigmaT) * t);
            });
            return deposit(value, m.flights.power, factor, frame, sums);
        }
    }
    const Vec3d value = m.perChannel([&](const auto& c) { return collisions(c.sigmaS, int(K)) * integral(c.sigmaT); });
    return deposit(value, m.flights.power, factor, frame, sums);
}

bool SliceEstimate::addVolumeSlice(const RaySliceQuery& m, int frame, double time, double width,
                                   FrameSums& sums) const {
    const auto w = m.directions<3>();
    const auto slice = sliceVolume(m.base, w, m.sight, m.residual(time));
    if (!slice) return false;
    double factor = unended(m.flights, m.medium, slice->lengths.data(), 3);
    if (!(factor > 0.0) || !unoccluded(m.flights, slice->lengths.data(), 3)) return false;
    factor *= m.phase(m.flights.directions[2]) * m.speed * width;
    if (m.flights.shared) factor *= volumeWeight(ratio(m, w, slice->lengths));
    const Vec3d value = m.perChannel([&](const auto& medium) { return slice->weight(medium); });
    return deposit(value, m.flights.power, factor, frame, sums);
}

bool SliceEstimate::addHypervolume(const RaySliceQuery& m, int frame, double time, double width,
                                   FrameSums& sums) const {
    auto chord = sliceHypervolume(m.base, m.directions<4>(), m.sight, m.residual(time));
    if (!chord) return false;
    if (m.flights.shortFlights) chord->keepFlights(flightEnds(m.flights, m.medium));
    const double factor = m.phase(m.flights.directions[3]) * m.speed * width;
    return addChord(m, *chord, frame, m.random(1, frame), factor, nullptr, sums);
}

// ---- Balls: at one time, and over a gate

bool SliceEstimate::addBall(const RaySliceQuery& m, FrameSums& sums) const {
    if (scene_.transport.gate.delta && !m.flights.blurredInTime())
        return eachSlice(
            m, [&](int frame, double time, double width) { return addBallSlice(m, frame, time, width, sums); });
    bool any = false;
    for (int frame = sensor_.gate.nearestFrame(m.start); frame < sensor_.gate.frames; ++frame)
        any = addBallGate(m, frame, sums) || any;
    return any;
}

Rgb SliceEstimate::leavingBall(const RaySliceQuery& m, const BallHit<double>& hit, const Vec3f& last) const {
    const SliceRecord& ball = m.flights;
    const Rgb power = ball.emitter >= 0 ? ball.power * emittedIntensity(scene_.emitters[size_t(ball.emitter)],
                                                                        ball.surfacePoint(), last)
                      : ball.onSurface  ? ball.power * ball.leavingSurface(last)
                                        : ball.power * m.medium.phase.eval(ball.directions[1], last);
    if (isBlack(power) || unoccluded(ball, Vec3f(m.sight.at(hit.alongRay)))) return power;
    return Rgb(0.0f);
}

bool SliceEstimate::unoccluded(const SliceRecord& ball, const Vec3f& end) const {
    if (!occluders_) return true;
    const Vec3f way = end - ball.base;
    const float length = way.length();
    if (!(length > 0.0f)) return true;
    const Vec3f direction = way / length;
    Ray ray = ball.emitter >= 0 || ball.onSurface ? ball.surfacePoint().spawnRay(direction) : Ray{ball.base, direction};
    ray.tMax = length;
    return !scene_.geometry->occluded(ray);
}

template <typename Ratio>
double SliceEstimate::ballShareOf(const RaySliceQuery& m, const Vec3d& last, double length, const Ratio& ratio) const {
    if (!m.flights.shared) return 1.0;
    const auto w = m.directions<2>();
    const auto& t = m.flights.lengths;
    return ballWeight(
        ratio(std::array<Vec3d, 3>{w[0], w[1], last}, std::array<double, 3>{double(t[0]), double(t[1]), length}));
}

bool SliceEstimate::addBallSlice(const RaySliceQuery& m, int frame, double time, double width, FrameSums& sums) const {
    const auto slice = sliceBall(m.base, m.sight, m.residual(time));
    bool any = false;
    for (int i = 0; i < slice.count; ++i) {
        const BallHit<double>& hit = slice.hits[size_t(i)];
        const Vec3d last = (m.sight.at(hit.alongRay) - m.base) / hit.length;
        double factor = m.speed * width * m.phase(Vec3f(last)) * unended(m.flights, m.medium, &hit.length, 1);
        if (!(factor > 0.0)) continue;
        factor *=
            ballShareOf(m, last, hit.length, [&](const auto& w, const auto& lengths) { return ratio(m, w, lengths); });
        const Vec3d value = m.perChannel([&](const auto& medium) { return hit.weight(medium); });
        any = deposit(value, leavingBall(m, hit, Vec3f(last)), factor, frame, sums) || any;
    }
    return any;
}

bool SliceEstimate::addBallGate(const RaySliceQuery& m, int frame, FrameSums& sums) const {
    const TimeGate& gate = sensor_.gate;
    const auto lit =
        gateBall<double>(m.base, m.sight, {m.residual(gate.frameStart(frame)), m.residual(gate.frameStart(frame + 1))});
    if (!(lit.angles() > 0.0)) return false;
    const auto hit = lit.sample(m.random(0, frame));
    if (!(hit.length > 0.0) || hit.length < double(m.flights.reach)) return false;
    const Vec3d towards = (m.sight.at(hit.alongRay) - m.base) / hit.length;
    const Vec3f last = Vec3f(towards);
    const double arrival = m.arrival(hit.length + m.sight.warp() * hit.alongRay);
    const double share = ballShareOf(m, towards, hit.length, [&](const auto& w, const auto& lengths) {
        return ratioInGate(m, w, lengths, hit.alongRay);
    });
    const double factor =
        m.phase(last) * double(sensor_.weight(arrival)) * unended(m.flights, m.medium, &hit.length, 1) * share;
    if (!(factor > 0.0)) return false;
    const Vec3d value = m.perChannel([&](const auto& medium) { return lit.weight(hit, medium); });
    return deposit(value, leavingBall(m, hit, last), factor, frame, sums);
}

} // namespace tungsten::photon
