#include "path/StepsToEmitter.h"

#include "path/Tuning.h"
#include "path/techniques/ShellChord.h"

#include "transport/PlainSteps.h"

#include <numeric>

namespace tungsten::path {

using transport::Ahead;
using transport::Flight;
using transport::WalkVertex;
using Event = transport::Flight::Event;

namespace {

/// Logarithm of what is too little to matter.
constexpr float NoUse = -1e30f;

/// A surface whose lobes are all smooth and reflect. Directions into it stand for absorption: their density is 0.
struct SurfaceScatterer {
    const SurfaceInteraction& surface;
    Sampler& random; ///< chooses among lobes

    [[nodiscard]] darts::Vec3 sample(float u, float v) const {
        const BsdfRandom numbers{{u, v}, random.next1D()};
        const auto sample = surface.bsdf->sample(surface.query(TransportMode::Radiance), surface.wi, numbers);
        return darts::vec3(sample ? surface.frame.toWorld(sample->wo).normalized() : -surface.frame.n);
    }
    [[nodiscard]] float pdf(const darts::Vec3& direction) const {
        return surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi,
                                 surface.frame.toLocal(darts::to<Vec3f>(direction)));
    }
};

} // namespace

bool endsReflectedLight(LobeMask lobes) {
    return (lobes & lobe::Smooth) != 0 && (lobes & (lobe::Specular | lobe::Through)) == 0;
}

const darts::Guide* StepsToEmitter::guideFor(const transport::Vertex& vertex, const Vec3f& back,
                                             const Region& region) const {
    if (!endsReflectedLight(vertex.lobes())) return nullptr;
    const Region ahead = vertex.regionTowards(back, region);
    const Medium* medium = context_.scene.medium(ahead);
    if (!medium || !medium->scatters()) return nullptr;
    const bool diffuse = (vertex.lobes() & lobe::DiffuseReflection) != 0;
    const auto& guides = diffuse ? guided_->guides.surfaces : guided_->guides.glossy;
    const darts::Guide& guide = guides[size_t(ahead.medium)];
    return guide.settings().direction == darts::Direction::Phase ? nullptr : &guide;
}

darts::ConnectionSample StepsToEmitter::drawConnection(PathState& path, const darts::Guide& guide,
                                                       const darts::Residual& residual) const {
    return guide.sampleConnection(
        residual, path.random.next1D(),
        {guided_->sensor.response.get(), path.time + target_->start, double(path.region.speed)});
}

// ---- Looking

void StepsToEmitter::lookAheadFrom(const PathState& path, const Vec3f& position) {
    const TimeGate& gate = guided_->sensor.arrivals;
    const PathTarget& target = *target_;
    const float speed = path.region.speed;
    const darts::TimeGate open{gate.start - target.start, gate.end() - target.start};
    const auto range = darts::ResidualRange::of(open, path.time, double(speed));
    const float faster = guided_->bound.oneSpeed() ? 0.0f : guided_->bound.highestSpeed() / speed - 1.0f;
    lookAhead(darts::Residual::of(darts::vec3(target.vertex.position() - position), range),
              target.reach + faster * std::max(float(range.high), 0.0f));
}

void StepsToEmitter::lookOutFrom(const PathState& path, const transport::Start& start) {
    if (hasLookedOut() || !guided_->waysOut) return;
    const PathTarget& target = *target_;
    const transport::Aim aim{target.vertex.position(), target.vertex.region().medium, target.vertex.margin(), nullptr,
                             true};
    lookOut(*guided_->waysOut, start, path.region, aim, context_.counters.rays);
}

float StepsToEmitter::logUsefulTarget(const PathState& path) {
    lookAheadFrom(path, path.ray.origin);
    if (!reachable().alive()) return NoUse;
    lookOutFrom(path, transport::Start::along(path.ray));
    const darts::Residual& residual = reachable();
    if (residual.way != darts::Way::Out) return NoUse;
    const float light = meanComponent(target_->intensity(-darts::to<Vec3f>(residual.axis)));
    return light > 0.0f ? guideOf(path.region).logUsefulness(residual, light / sqr(residual.C)) : NoUse;
}

/// Resampled importance sampling: for any weights the estimate of whatever depends on the point stays exact.
void StepsToEmitter::chooseTarget(PathState& path) {
    constexpr size_t Points = tuning::EntryPoints;
    PathTarget& target = *target_;
    choosesTarget_ = false;
    if (path.scattered || !TargetChoice::hasOthers(*target.emitter)) return;
    std::array<std::optional<PathTarget>, Points> points;
    std::array<float, Points> weights;
    points[0] = target;
    Sampler others = path.random.branch(RandomStream::EntryPoint, uint64_t(path.interactions));
    for (size_t i = 0; i < Points; ++i) {
        if (i > 0) points[i] = guided_->targets->another(target, others);
        if (!points[i]) return;
        target = *points[i];
        weights[i] = logUsefulTarget(path);
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
    lookAheadFrom(path, path.ray.origin);
    lookOutFrom(path, transport::Start::along(path.ray));
    path.throughput = path.throughput * (sum / (float(Points) * (weights[chosen] + least)));
    ++counters_->pointsChosen;
}

bool StepsToEmitter::canArrive(PathState& path, const WalkVertex& vertex) {
    surfaceGuide_ = nullptr;
    if (path.timed) {
        lookAheadFrom(path, vertex.position);
        if (!reachable().alive()) return false;
    }
    if (vertex.medium) {
        lookOutFrom(path, {vertex.position});
        return true;
    }
    const SurfaceInteraction& surface = *vertex.surface;
    surfaceGuide_ = guideFor(vertex.connectible(context_.scene, TransportMode::Radiance), -vertex.before, path.region);
    if (!surfaceGuide_) return true;
    // It scatters back, into the region there.
    path.timed = path.scattered = true;
    path.region = regionBeyond(surface, -vertex.before, path.region);
    lookAheadFrom(path, vertex.position);
    if (residual().alive()) lookOutFrom(path, {vertex.position, surface.hit.margin()});
    return true;
}

// ---- Flights

Ahead StepsToEmitter::ahead(PathState& path) {
    if (std::exchange(startsAnew_, false) && path.timed) lookAheadFrom(path, path.ray.origin);
    const Medium* medium = context_.scene.medium(path.region);
    if (!medium || !medium->scatters()) return aheadInEmpty(path, medium);
    return path.timed ? aheadInMedium(path, *medium) : aheadUntimed(path, *medium);
}

Ahead StepsToEmitter::aheadInEmpty(PathState& path, const Medium* medium) {
    passage_ = Passage::Empty;
    if (path.timed) {
        if (!reachable().alive()) return {};
        path.ray.tMax = bound(path.ray.direction);
    }
    ++context_.counters.rays;
    Ahead ahead{true, medium, context_.scene.geometry->intersect(path.ray)};
    ahead.flies = ahead.hit.has_value();
    if (medium && ahead.flies) context_.counters.fly(*medium);
    return ahead;
}

Ahead StepsToEmitter::aheadInMedium(PathState& path, const Medium& medium) {
    passage_ = Passage::Medium;
    if (!transport::BounceLimits::fly(path.flights, medium)) return {};
    lookOutFrom(path, transport::Start::along(path.ray));
    if (choosesTarget_ && reachable().way == darts::Way::Out) chooseTarget(path);
    if (!reachable().alive()) return {};
    const darts::Guide& guide = guideOf(path.region);
    startRoulette(guide, path.region.medium, meanComponent(path.throughput));
    heading_ = headingOf(path.ray.direction);
    path.ray.tMax = bound(guide, heading_.h);
    ++context_.counters.rays;
    const Ahead ahead{true, &medium, context_.scene.geometry->intersect(path.ray)};
    // What the camera sees beyond the fog, or of lamps there, has been connected to by no vertex.
    if (ahead.hit && reachable().way == darts::Way::Out && reachable().exit.connects && path.mediumScatters > 0)
        leaveWithOdds(guided_->waysOut->leaveOdds(path.region, path.ray.direction, *ahead.hit));
    return ahead;
}

Ahead StepsToEmitter::aheadUntimed(PathState& path, const Medium& medium) {
    passage_ = Passage::Untimed;
    if (!transport::BounceLimits::fly(path.flights, medium)) return {};
    lookAheadFrom(path, path.ray.origin);
    ++context_.counters.rays;
    return {true, &medium, context_.scene.geometry->intersect(path.ray)};
}

Flight StepsToEmitter::flight(PathState& path, const Ahead& ahead) {
    if (passage_ == Passage::Untimed) return flyUntimed(path, ahead);
    if (passage_ == Passage::Empty)
        return {Event::Surface, ahead.reach(), ahead.medium ? ahead.medium->transmittance(ahead.reach()) : Rgb(1.0f)};
    const darts::Guide& guide =
        path.mediumScatters == 0 ? guided_->guides.view[size_t(path.region.medium)] : guideOf(path.region);
    path.random.at(path.interactions + 1, Draw::Distance);
    const darts::DistanceSample sample =
        sampleDistance(guide, heading_, ahead.reach(), path.throughput, [&] { return path.random.next1D(); });
    const Rgb weight = darts::to<Rgb>(sample.transmittanceOverPdf);
    if (sample.surface) return {Event::Surface, ahead.reach(), weight, 0.0f};
    return {Event::Collision, sample.distance, weight * ahead.medium->sigmaS(), 0.0f};
}

/// The surface by its transmittance; in the medium a distance from which light may still arrive, half of them by
/// transmittance, half by angle.
Flight StepsToEmitter::flyUntimed(PathState& path, const Ahead& ahead) {
    const Medium& medium = *ahead.medium;
    const float surface = ahead.reach();
    // Only vertices in the medium must lie in the ball from which light is in time: mirrors farther away still count.
    const double reach = double(reachable().C) + double(reachable().excess);
    const ShellChord chord(target_->vertex.position() - path.ray.origin, path.ray.direction, 0.0, reach,
                           double(surface));
    float staying = 1.0f;
    if (ahead.hit) {
        const Rgb reaching = medium.transmittance(surface);
        const float probability = chord.empty() ? 1.0f : meanComponent(reaching);
        path.random.at(path.interactions + 1, Draw::Flight);
        if (path.random.next1D() < probability) return {Event::Surface, surface, reaching / probability, probability};
        staying = 1.0f - probability;
    }
    if (chord.empty()) return {};
    const darts::ConnectionLength<double> flights{chord.begin(), chord.end() - chord.begin(),
                                                  double(meanComponent(medium.sigmaT()))};
    path.random.at(path.interactions + 1, Draw::Distance);
    const double u = path.random.nextDouble();
    const double t = path.random.next1D() < 0.5f ? chord.begin() + flights.sample(u).offset : chord.sample(u);
    const double pdf = (0.5 * flights.pdf(t - chord.begin()) + 0.5 * chord.pdf(t)) * double(staying);
    if (!(pdf > 0.0)) return {};
    const auto distance = float(t);
    return {Event::Collision, distance, medium.sigmaS() * medium.transmittance(distance) * float(1.0 / pdf),
            float(pdf)};
}

// ---- Roulette, splitting, directions

bool StepsToEmitter::passesRoulette(PathState& path, const darts::Guide& guide) {
    const float survival = GuidedSteps::survival(guide, path.region.medium, meanComponent(path.throughput));
    if (survival >= 1.0f) return true;
    path.random.at(path.interactions, Draw::Roulette);
    if (!(path.random.next1D() < survival)) return false;
    path.throughput = path.throughput / survival;
    return true;
}

int StepsToEmitter::copies(PathState& path, const WalkVertex& vertex) {
    if (vertex.surface) return guidesSurface() && !passesRoulette(path, *surfaceGuide_) ? 0 : 1;
    const darts::Guide& guide = guideOf(path.region);
    return passesRoulette(path, guide) ? copiesBy(guide) : 0;
}

template <typename Scatterer>
darts::DirectionSample StepsToEmitter::draw(PathState& path, const darts::Guide& guide, const Scatterer& scatterer) {
    const bool lengthFirst = guide.settings().lengthFirst, elliptical = guide.settings().elliptical;
    path.random.at(path.interactions, Draw::Connection);
    if (lengthFirst) connect(drawConnection(path, guide, residual()));
    path.random.at(path.interactions, Draw::GuidedDirection);
    const darts::DirectionSample sample =
        sampleDirection(guide, scatterer, darts::NoView{}, [&] { return path.random.next1D(); });
    if (lengthFirst && elliptical)
        place({guide, sample.h, path.time, sharesConnections()});
    else
        startWay();
    return sample;
}

std::optional<transport::Way> StepsToEmitter::way(PathState& path, const WalkVertex& vertex) {
    if (vertex.medium) return leaveMedium(path, vertex);
    return guidesSurface() ? leaveGuided(path, vertex) : leavePlainly(path, vertex);
}

transport::Way StepsToEmitter::leaveMedium(PathState& path, const WalkVertex& vertex) {
    const darts::Guide& guide = guideOf(path.region);
    startWay();
    if (!residual().alive() || guide.settings().direction == darts::Direction::Phase)
        return transport::sampleMediumWay(path, vertex);
    const PhaseFunction& phase = vertex.medium->phase;
    const darts::DirectionSample sample = draw(path, guide, darts::PhaseScatterer{phase, vertex.before});
    const Vec3f direction = darts::to<Vec3f>(sample.direction);
    const float own = phase.eval(vertex.before, direction);
    return {Ray{vertex.position, direction}, path.region, Rgb(own * sample.inversePdf), own};
}

transport::Way StepsToEmitter::leaveGuided(PathState& path, const WalkVertex& vertex) {
    startWay();
    const darts::DirectionSample sample = draw(path, *surfaceGuide_, SurfaceScatterer{*vertex.surface, path.random});
    const Ray ray = vertex.surface->hit.leave(darts::to<Vec3f>(sample.direction));
    const transport::Vertex here = vertex.connectible(context_.scene, TransportMode::Radiance);
    return {ray, path.region, here.scattering(ray.direction) * sample.inversePdf, here.pdf(ray.direction),
            lobe::DiffuseReflection};
}

std::optional<transport::Way> StepsToEmitter::leavePlainly(PathState& path, const WalkVertex& vertex) {
    const auto way =
        transport::sampleSurfaceWay(path, vertex, TransportMode::Radiance, context_.scene.transport.consistencyChecks);
    if (!way) return way;
    // A connection drawn before goes on through a boundary that light passes straight at its speed.
    if (way->straight() && way->region.speed == path.region.speed)
        passBoundary(vertex.surface->hit.t);
    else
        startWay();
    startsAnew_ = true;
    return way;
}

} // namespace tungsten::path
