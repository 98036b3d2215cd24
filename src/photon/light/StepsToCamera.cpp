#include "photon/light/StepsToCamera.h"

#include "transport/PlainSteps.h"

namespace tungsten::photon {

using transport::Ahead;
using transport::Flight;
using transport::PathState;
using transport::WalkVertex;
using transport::Way;

Ahead StepsToCamera::ahead(PathState& path) {
    const Medium* medium = context_.scene.medium(path.region);
    guide_ = guidance_->guide(path.region);
    if (guide_) {
        if (!transport::BounceLimits::fly(path.flights, *medium)) return {};
        const bool afterSurface = !hasLooked();
        if (afterSurface && (!lookFrom(path, transport::Start::along(path.ray)) || !passesRoulette(path, *guide_)))
            return {};
        heading_ = headingOf(path.ray.direction);
        path.ray.tMax = bound(*guide_, heading_.h);
    }
    if (medium) context_.counters.fly(*medium);
    ++context_.counters.rays;
    const Ahead ahead{true, medium, context_.scene.geometry->intersect(path.ray)};
    path.ray.tMax = Infinity;
    if (guide_ && ahead.hit && residual().way == darts::Way::Out && residual().exit.connects)
        leaveWithOdds(guidance_->leaveOdds(path.region, path.ray.direction, *ahead.hit));
    return ahead;
}

Flight StepsToCamera::flight(PathState& path, const Ahead& ahead) {
    using Event = Flight::Event;
    if (!guide_) {
        if (!ahead.hit) return {Event::Escape};
        return {Event::Surface, ahead.hit->t, ahead.medium ? ahead.medium->transmittance(ahead.hit->t) : Rgb(1.0f)};
    }
    path.random.at(path.interactions + 1, Draw::Distance);
    const darts::DistanceSample sample =
        sampleDistance(*guide_, heading_, ahead.reach(), path.throughput, [&] { return path.random.next1D(); });
    const Rgb weight = darts::to<Rgb>(sample.transmittanceOverPdf);
    if (sample.surface) return {Event::Surface, ahead.hit->t, weight, 0.0f};
    // As it is stored, so that times are those of the path that is gathered.
    const double length = transport::distanceBetween(path.ray.origin, path.ray.at(sample.distance));
    return {Event::Collision, sample.distance, weight * ahead.medium->sigmaS(), 0.0f, length};
}

bool StepsToCamera::lookFrom(const PathState& path, const transport::Start& start) {
    setTimeBudget(guidance_->residual(start, path.region, path.time, gate_, context_.counters.rays));
    return residual().alive();
}

bool StepsToCamera::canArrive(PathState& path, const WalkVertex& vertex) {
    forget();
    return vertex.surface || lookFrom(path, {vertex.position});
}

bool StepsToCamera::passesRoulette(PathState& path, const darts::Guide& guide) {
    const int medium = path.region.medium;
    const float power = meanComponent(path.throughput);
    const bool out = residual().way == darts::Way::Out;
    if (rules_.measured && out) {
        rules_.measured->record(medium, guide.logUsefulness(reachable(), power));
        return false;
    }
    const float others = out && rules_.first ? rules_.first->logged(medium) : NoOthers;
    const float survival = GuidedSteps::survival(guide, medium, power, others);
    if (survival >= 1.0f) return true;
    path.random.at(path.interactions, Draw::Roulette);
    if (path.random.next1D() >= survival) return false;
    path.throughput = path.throughput / survival;
    return true;
}

int StepsToCamera::copies(PathState& path, const WalkVertex& vertex) {
    if (vertex.surface) return 1; // where the next flight starts
    return passesRoulette(path, *guide_) ? copiesBy(*guide_) : 0;
}

std::optional<Way> StepsToCamera::way(PathState& path, const WalkVertex& vertex) {
    if (vertex.surface)
        return transport::sampleSurfaceWay(path, vertex, TransportMode::Photons,
                                           context_.scene.transport.consistencyChecks);
    const PhaseFunction& phase = vertex.medium->phase;
    Vec3f direction;
    const auto inversePdf = draw(path, *guide_, darts::PhaseScatterer{phase, vertex.before}, direction);
    if (!inversePdf) return std::nullopt;
    const float own = phase.eval(vertex.before, direction);
    return Way{Ray{vertex.position, direction}, path.region, Rgb(own * *inversePdf), own};
}

darts::ConnectionSample StepsToCamera::drawConnection(PathState& path, const darts::Guide& guide,
                                                      const darts::Residual& residual) const {
    if (guidance_->meetsDeltaGate() && rules_.storesVertices) return guidance_->onDeltaGate(residual);
    return guide.sampleConnection(residual, path.random.next1D(), guidance_->response(path.time));
}

auto StepsToCamera::controlVertex(PathState& path, const Ahead& ahead, bool shares) -> std::optional<OnWay> {
    const auto draw = [&](const darts::Residual& residual) {
        path.random.at(path.interactions + 1, Draw::FlightConnection);
        return drawConnection(path, *guide_, residual);
    };
    return meetControlVertex({*guide_, heading_.h, path.time, shares}, ahead.reach(), draw);
}

} // namespace tungsten::photon
