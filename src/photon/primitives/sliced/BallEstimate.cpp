// Balls: at one time, and over a gate.

#include "photon/primitives/sliced/ShortFlights.h"
#include "photon/primitives/sliced/SliceEstimate.h"

namespace tungsten::photon {

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
    if (isBlack(power) || unoccluded(ball, inFloat(m.sight.at(hit.alongRay)))) return power;
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
        double factor = m.speed * width * m.phase(inFloat(last)) * unended(m.flights, m.medium, &hit.length, 1);
        if (!(factor > 0.0)) continue;
        factor *=
            ballShareOf(m, last, hit.length, [&](const auto& w, const auto& lengths) { return ratio(m, w, lengths); });
        const Vec3d value = m.perChannel([&](const auto& medium) { return hit.weight(medium); });
        any = deposit(value, leavingBall(m, hit, inFloat(last)), factor, frame, sums) || any;
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
    const Vec3f last = inFloat(towards);
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
