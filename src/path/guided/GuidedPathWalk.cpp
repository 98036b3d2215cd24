// The walk's flights: through media towards what can still arrive inside the gate, and when it ends.

#include "path/guided/GuidedPathWalk.h"

#include "path/Tuning.h"
#include "path/techniques/ControlVertices.h"
#include "path/techniques/EmitterConnections.h"
#include "path/techniques/ShellChord.h"

#include <numeric>

namespace tungsten::path {

namespace {

/// Logarithm of what is too little to matter.
constexpr float NoUse = -1e30f;

} // namespace

void GuidedPathWalk::run(const Ray& ray, PathTarget target) {
    path_.target = &target;
    if (context_.targets) target_ = &target;
    path_.state.ray = ray;
    path_.state.region = scene_.cameraRegion;
    ++path_.state.counters.paths;
    if (path_.state.timed()) lookAhead(ray.origin);
    goOn();
}

void GuidedPathWalk::goOn() {
    while (path_.state.interactions < scene_.transport.maxBounces) {
        path_.state.counters.step(context_.watch);
        const Medium* medium = scene_.medium(path_.state.region);
        if (!medium || !medium->scatters()) {
            if (!crossEmpty()) return;
        } else if (path_.state.timed()) {
            if (!crossMedium(*medium)) return;
        } else if (!crossUntimed(*medium)) {
            return;
        }
    }
}

void GuidedPathWalk::lookAhead(const Vec3f& position) {
    const TimeGate& gate = context_.sensor.arrivals;
    const PathTarget& target = *path_.target;
    const float speed = path_.state.region.speed;
    const darts::TimeGate open{gate.start - target.start, gate.end() - target.start};
    const auto range = darts::ResidualRange::of(open, path_.state.time, double(speed));
    const float faster = context_.bound.oneSpeed() ? 0.0f : context_.bound.highestSpeed() / speed - 1.0f;
    path_.step.lookAhead(darts::Residual::of(darts::vec3(target.vertex.position() - position), range),
                         target.reach + faster * std::max(float(range.high), 0.0f));
}

void GuidedPathWalk::lookOut(const transport::Start& start) {
    if (path_.step.hasLookedOut() || !context_.waysOut) return;
    const PathTarget& target = *path_.target;
    const transport::Aim aim{target.vertex.position(), target.vertex.region().medium, target.vertex.margin(), nullptr,
                             true};
    path_.step.lookOut(*context_.waysOut, start, path_.state.region, aim, path_.state.counters.rays);
}

float GuidedPathWalk::logUsefulTarget() {
    lookAhead(path_.state.ray.origin);
    if (!path_.step.reachable().alive()) return NoUse;
    lookOut(transport::Start::along(path_.state.ray));
    const darts::Residual& residual = path_.step.reachable();
    if (residual.way != darts::Way::Out) return NoUse;
    const float light = meanComponent(path_.target->intensity(-darts::to<Vec3f>(residual.axis)));
    return light > 0.0f ? path_.guideOf(path_.state.region).logUsefulness(residual, light / sqr(residual.C)) : NoUse;
}

/// Resampled importance sampling: for any weights the estimate of whatever depends on the point stays exact.
void GuidedPathWalk::chooseTarget() {
    constexpr size_t Points = tuning::EntryPoints;
    CameraPath& state = path_.state;
    PathTarget& target = *std::exchange(target_, nullptr);
    if (state.scattered || !TargetChoice::hasOthers(*target.emitter)) return;
    std::array<std::optional<PathTarget>, Points> points;
    std::array<float, Points> weights;
    points[0] = target;
    Sampler others = state.sampler.branch(RandomStream::EntryPoint, uint64_t(state.interactions));
    for (size_t i = 0; i < Points; ++i) {
        if (i > 0) points[i] = context_.targets->another(target, others);
        if (!points[i]) return;
        target = *points[i];
        weights[i] = logUsefulTarget();
    }
    const float highest = *std::max_element(weights.begin(), weights.end());
    for (float& weight : weights) weight = std::exp(weight - highest); // alike if there is no use
    float sum = std::accumulate(weights.begin(), weights.end(), 0.0f);
    const float least = tuning::LeastPoint * sum / float(Points);
    sum += least * float(Points);
    float rest = others.next1D() * sum;
    size_t chosen = 0;
    while (chosen + 1 < Points && (rest -= weights[chosen] + least) >= 0.0f) ++chosen;
    target = *points[chosen];
    lookAhead(state.ray.origin);
    lookOut(transport::Start::along(state.ray));
    state.throughput = state.throughput * (sum / (float(Points) * (weights[chosen] + least)));
    ++state.counters.pointsChosen;
}

bool GuidedPathWalk::survives(const darts::Guide& guide) {
    CameraPath& state = path_.state;
    const float survival = path_.step.survival(guide, state.region.medium, meanComponent(state.throughput));
    if (survival >= 1.0f) return true;
    state.sampler.at(state.interactions, Draw::Roulette);
    if (!(path_.next() < survival)) return false;
    state.throughput = state.throughput / survival;
    return true;
}

bool GuidedPathWalk::crossEmpty() {
    CameraPath& state = path_.state;
    if (state.timed()) {
        if (!path_.step.reachable().alive()) return false;
        state.ray.tMax = path_.step.bound(state.ray.direction);
    }
    ++state.counters.rays;
    const auto hit = scene_.geometry->intersect(state.ray);
    if (!hit) return false;
    if (const Medium* medium = scene_.medium(state.region)) {
        state.counters.fly(*medium);
        state.throughput = state.throughput * medium->transmittance(hit->t);
    }
    findAt(*hit, state.throughput);
    return !isBlack(state.throughput) && scatterOnSurface(*hit);
}

bool GuidedPathWalk::crossMedium(const Medium& medium) {
    CameraPath& state = path_.state;
    transport::GuidedSteps& step = path_.step;
    if (!path_.mayFly(&medium)) return false;
    lookOut(transport::Start::along(state.ray));
    if (target_ && step.reachable().way == darts::Way::Out) chooseTarget();
    if (!step.reachable().alive()) return false;
    ++state.flights;
    const darts::Guide& guide = path_.guideOf(state.region);
    step.startRoulette(guide, state.region.medium, meanComponent(state.throughput));
    const darts::Heading heading = step.heading(state.ray.direction);
    state.ray.tMax = step.bound(guide, heading.h);
    ++state.counters.rays;
    const auto hit = scene_.geometry->intersect(state.ray);
    const float surface = hit ? hit->t : Infinity;
    // What the camera sees beyond the fog, or of lamps there, has been connected to by no vertex.
    if (hit && step.reachable().way == darts::Way::Out && step.reachable().exit.connects && state.mediumScatters > 0)
        step.leaveWithOdds(context_.waysOut->leaveOdds(state.region, state.ray.direction, *hit));
    ControlVertices::sample(path_, medium, guide, heading.h, surface);
    // In expectation, whether or not the walk goes there.
    if (hit) findAt(*hit, state.throughput * medium.transmittance(surface));
    const darts::Guide& flights = state.mediumScatters == 0 ? context_.guides.view[size_t(state.region.medium)] : guide;
    state.sampler.at(state.interactions + 1, Draw::Distance);
    const darts::DistanceSample flight =
        step.sampleDistance(flights, heading, surface, state.throughput, [this] { return path_.next(); });
    const Rgb weight = darts::to<Rgb>(flight.transmittanceOverPdf);
    state.throughput = state.throughput * (flight.surface ? weight : weight * medium.sigmaS());
    if (isBlack(state.throughput)) return false;
    return flight.surface ? scatterOnSurface(*hit) : scatterInMedium(medium, flight.distance);
}

/// A camera segment that does not count: time starts at the vertex on it.
bool GuidedPathWalk::crossUntimed(const Medium& medium) {
    CameraPath& state = path_.state;
    if (!path_.mayFly(&medium)) return false;
    ++state.flights;
    lookAhead(state.ray.origin);
    const darts::Residual& reachable = path_.step.reachable();
    const double reach = double(reachable.C) + double(reachable.excess);
    ++state.counters.rays;
    const auto hit = scene_.geometry->intersect(state.ray);
    const float surface = hit ? hit->t : Infinity;
    ControlVertices::sampleUntimed(path_, medium, surface);
    // Only vertices in the medium must lie in the ball from which light is in time: mirrors farther away still count.
    const Vec3f toTarget = path_.target->vertex.position() - state.ray.origin;
    const ShellChord inTime(toTarget, state.ray.direction, 0.0, reach, double(surface));
    float staying = 1.0f;
    if (hit) {
        const Rgb reaching = medium.transmittance(surface);
        findAt(*hit, state.throughput * reaching);
        const float probability = inTime.empty() ? 1.0f : meanComponent(reaching);
        state.sampler.at(state.interactions + 1, Draw::Flight);
        if (path_.next() < probability) {
            state.throughput = state.throughput * (reaching / probability);
            return scatterOnSurface(*hit);
        }
        staying = 1.0f - probability;
    }
    const auto distance = sampleUntimed(medium, inTime, staying);
    return distance && !isBlack(state.throughput) && scatterInMedium(medium, *distance);
}

/// A distance from which light may still arrive, half of them by transmittance, half by angle; the throughput includes
/// its scattering.
std::optional<float> GuidedPathWalk::sampleUntimed(const Medium& medium, const ShellChord& chord,
                                                   float probability) {
    if (chord.empty()) return std::nullopt;
    const darts::ConnectionLength<double> flights{chord.begin(), chord.end() - chord.begin(),
                                                  double(meanComponent(medium.sigmaT()))};
    path_.state.sampler.at(path_.state.interactions + 1, Draw::Distance);
    const double u = path_.state.sampler.nextDouble();
    const double t = path_.next() < 0.5f ? chord.begin() + flights.sample(u).offset : chord.sample(u);
    const double pdf = 0.5 * flights.pdf(t - chord.begin()) + 0.5 * chord.pdf(t);
    if (!(pdf > 0.0)) return std::nullopt;
    Rgb& throughput = path_.state.throughput;
    throughput = throughput * (medium.sigmaS() * medium.transmittance(float(t)) * float(1.0 / (pdf * double(probability))));
    return float(t);
}

void GuidedPathWalk::findAt(const SurfaceHit& hit, const Rgb& throughput) {
    if (isBlack(throughput)) return;
    EmittersMet::add(path_, hit, throughput);
    if ((scene_.bsdfOf(hit).lobes() & lobe::Smooth) != 0) ConnectionsFromSurfaces::connect(path_, hit, throughput);
}

} // namespace tungsten::path
