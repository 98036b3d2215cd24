#include "path/PlainTrail.h"

#include "path/techniques/EmitterConnections.h"
#include "path/techniques/LightCaches.h"

#include "transport/PlainSteps.h"

namespace tungsten::path {

using transport::Ahead;
using transport::Flight;
using transport::WalkVertex;
using Event = Flight::Event;

namespace {

constexpr float Never = StrategyBalance::Never;

} // namespace

void PlainTrail::start(const GuidedContext& context, const TargetChoice& targets, PixelAccumulator& sink,
                       PathCounters& counters, const Sampler& light) {
    record_.clear();
    for (; used_ > 0; --used_) slots_[followers_[used_ - 1]->slot] = 0;
    slots_.resize(context.scene.emitters.size() * context.windows.size(), 0);
    context_ = &context;
    targets_ = &targets;
    sink_ = &sink;
    counters_ = &counters;
    light_ = light;
}

auto PlainTrail::follower(size_t emitter, size_t window) -> Follower& {
    const size_t slot = emitter * context_->windows.size() + window;
    if (const uint32_t place = slots_[slot]; place > 0) return *followers_[place - 1];
    const Follower* same = window > 0 ? &follower(emitter, 0) : nullptr;
    if (used_ == followers_.size()) followers_.emplace_back();
    Follower& follower = followers_[used_++].emplace();
    follower.slot = slot;
    slots_[slot] = uint32_t(used_);
    if (same) {
        if (same->steps) follower.steps.emplace(*context_, *counters_, same->steps->target(), window);
    } else {
        Sampler random = light_->branch(RandomStream::Target, emitter);
        const auto target = targets_->of(emitter, random, context_->watch, *counters_);
        if (target) follower.steps.emplace(*context_, *counters_, *target);
    }
    follower.alive = follower.steps.has_value();
    return follower;
}

auto PlainTrail::now(size_t emitter, size_t window) -> const Logs& {
    Follower& follower = this->follower(emitter, window);
    followUntil(follower, record_.size());
    return follower.logs;
}

float PlainTrail::connectionsOverPlain(size_t emitter, const SurfaceHit& met, double time) {
    size_t flights = record_.size();
    while (flights > 0 && !record_[flights - 1].medium) --flights;
    Follower follower;
    follower.steps.emplace(*context_, *counters_,
                           targets_->at(emitter, SurfaceSample{met.position, met.ng, met.uv, met.error, met.index()}),
                           context_->windows.indexOf(time));
    followUntil(follower, flights);
    return follower.steps->connectionsOverPlain(follower.logs.ending);
}

void PlainTrail::pass(Follower& follower, const Step& step) {
    PathState guided = step.at;
    guided.logRatio = follower.logRatio;
    guided.throughput = transport::WalkRecord::throughputOfGuided(step.at.throughput, follower.logRatio);
    std::optional<SurfaceInteraction> surface;
    if (!step.medium) surface.emplace(makeInteraction(context_->scene, *step.hit, guided.ray.direction));
    const WalkVertex vertex{step.medium, surface ? &*surface : nullptr, guided.ray.origin, guided.ray.direction,
                            guided.region};
    StepsToEmitter& steps = *follower.steps;
    WayBehind& behind = follower.behind;
    follower.alive = steps.canArrive(guided, vertex);
    if (!follower.alive) return;
    const transport::Vertex here = vertex.connectible(context_->scene, TransportMode::Radiance);
    if (vertex.medium)
        behind.approachInMedium(*context_, guided, step.flight.distance);
    else
        behind.approachOnSurface(steps, guided, here, vertex.surface->hit);
    if (vertex.medium || steps.surfaceGuide()) behind.connect(*context_, steps.target().index, guided);
    guided.logRatio += std::log(steps.expectedCopies(guided, vertex));
    steps.leaveAlong(guided, vertex, *step.way);
    if (context_->settings.russianRoulette)
        guided.logRatio -=
            std::log(transport::survivalByThroughput(step.at.throughput * step.way->weight, step.at.interactions));
    follower.logRatio = guided.logRatio;
}

float PlainTrail::byLightCaches(Follower& follower, const Step& step) {
    const float alone = follower.steps->logRatioOnSurface();
    if (follower.behind.caches == Caches::None) return alone;
    PathState state = step.start;
    const GuidedPath path{*context_, *sink_, *counters_, state, *follower.steps, follower.behind};
    const transport::Vertex vertex = path.vertexOn(makeInteraction(context_->scene, *step.hit, state.ray.direction));
    const auto way = transport::connectionSegment(step.hit->position, path.target().vertex.position());
    if (!way) return alone;
    const float share = ConnectionsFromSurfaces::shareOfWalk(path, vertex, step.hit->t, *way);
    return share < 1.0f ? path.logRatioByLightCaches(vertex, share) : alone;
}

void PlainTrail::follow(Follower& follower, size_t index) {
    const Step& step = record_[index];
    Logs& logs = follower.logs;
    logs = {Never, Never, Never, Never};
    if (follower.alive && index > 0) pass(follower, record_[index - 1]);
    if (!follower.alive) return;
    ++counters_->densities;
    PathState guided = step.start;
    guided.logRatio = follower.logRatio;
    guided.throughput = transport::WalkRecord::throughputOfGuided(step.start.throughput, follower.logRatio);
    guided.ray.tMax = Infinity;
    const Medium* medium = context_->scene.medium(guided.region);
    if (medium && medium->scatters()) --guided.flights;
    const bool hits = step.flight.event == Event::Surface;
    StepsToEmitter& steps = *follower.steps;
    const Ahead ahead = steps.ahead(guided, hits ? &*step.hit : nullptr);
    // Beyond the bound in time guided paths do not fly.
    follower.alive = ahead.flies && (!hits || ahead.hit);
    if (!follower.alive) return;
    logs.light = hits ? steps.logRatioOnSurface() : Never;
    logs.ending = hits ? logs.light : steps.inMedium(step.flight.distance).logRatio;
    logs.openEnding = hits ? byLightCaches(follower, step) : logs.ending;
    logs.there = follower.logRatio = steps.logRatioThere(step.flight);
    follower.behind.arrive(follower.logRatio);
}

} // namespace tungsten::path
