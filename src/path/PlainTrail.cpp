#include "path/PlainTrail.h"

#include "path/techniques/EmitterConnections.h"
#include "path/techniques/LightPaths.h"

#include "transport/Roulette.h"

namespace tungsten::path {

using transport::Ahead;
using transport::Flight;
using transport::WalkVertex;
using Event = Flight::Event;

namespace {

/// Where guided paths do not come.
constexpr float Never = -80.0f;

/// Of the same path, found by guided steps.
Rgb guidedThroughput(const Rgb& plain, float logRatio) {
    return plain * std::exp(std::min(-logRatio, 80.0f));
}

} // namespace

auto PlainTrail::at(size_t step) -> const Step& {
    while (next_ <= step) follow(next_++);
    return steps_[step];
}

void PlainTrail::pass(const Step& step) {
    PathState guided = step.at;
    guided.logRatio = logRatio_;
    guided.throughput = guidedThroughput(step.at.throughput, logRatio_);
    std::optional<SurfaceInteraction> surface;
    if (!step.medium) surface.emplace(makeInteraction(context_->scene, *step.hit, guided.ray.direction));
    const WalkVertex vertex{step.medium, surface ? &*surface : nullptr, guided.ray.origin, guided.ray.direction,
                            guided.region};
    alive_ = guided_->canArrive(guided, vertex);
    if (!alive_) return;
    const transport::Vertex here = vertex.connectible(context_->scene, TransportMode::Radiance);
    if (vertex.medium)
        behind_.approachInMedium(*context_, guided, step.flight.distance);
    else
        behind_.approachOnSurface(*guided_, guided, here, vertex.surface->hit);
    if (vertex.medium || guided_->surfaceGuide()) behind_.connect(*context_, guided_->target().index, guided);
    guided.logRatio += std::log(guided_->expectedCopies(guided, vertex));
    guided_->leaveAlong(guided, vertex, *step.way);
    if (context_->settings.russianRoulette)
        guided.logRatio -=
            std::log(transport::survivalByThroughput(step.at.throughput * step.way->weight, step.at.interactions));
    logRatio_ = guided.logRatio;
}

float PlainTrail::byLightPaths(const Step& step) {
    const float alone = guided_->logRatioOnSurface();
    if (behind_.caches == Caches::None) return alone;
    PathState state = step.start;
    const GuidedPath path{*context_, *sink_, *counters_, state, *guided_, behind_};
    const transport::Vertex vertex = path.vertexOn(makeInteraction(context_->scene, *step.hit, state.ray.direction));
    const auto way = transport::straightWay(step.hit->position, path.target().vertex.position());
    if (!way) return alone;
    const float share = ConnectionsFromSurfaces::shareOfWalk(path, vertex, step.hit->t, *way);
    return share < 1.0f ? path.logRatioByLightPaths(vertex, share) : alone;
}

void PlainTrail::follow(size_t index) {
    Step& step = steps_[index];
    step.ending = step.openEnding = step.light = step.there = Never;
    if (!alive_) return;
    if (index > 0) pass(steps_[index - 1]);
    if (!alive_) return;
    ++counters_->densities;
    PathState guided = step.start;
    guided.logRatio = logRatio_;
    guided.throughput = guidedThroughput(step.start.throughput, logRatio_);
    guided.ray.tMax = Infinity;
    const Medium* medium = context_->scene.medium(guided.region);
    if (medium && medium->scatters()) --guided.flights;
    const bool hits = step.flight.event == Event::Surface;
    const Ahead ahead = guided_->ahead(guided, hits ? &*step.hit : nullptr);
    // Beyond the bound in time guided paths do not fly.
    alive_ = ahead.flies && (!hits || ahead.hit);
    if (!alive_) return;
    step.light = hits ? guided_->logRatioOnSurface() : Never;
    step.ending = hits ? step.light : guided_->inMedium(step.flight.distance).logRatio;
    step.openEnding = hits ? byLightPaths(step) : step.ending;
    step.there = logRatio_ = guided_->logRatioThere(step.flight);
    behind_.arrive(logRatio_);
}

} // namespace tungsten::path
