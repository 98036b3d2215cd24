#include "path/PathVisitor.h"

#include "path/Tuning.h"

#include "transport/Balance.h"

namespace tungsten::path {

using transport::Ahead;
using transport::Flight;
using transport::Vertex;
using transport::WalkVertex;
using transport::Way;

template <bool TimeResolved, typename Beside>
bool PathVisitor<TimeResolved, Beside>::ahead(PathState& path, auto&, const Ahead& ahead) {
    beside_.fly(path, ahead);
    if (!context_->refracted || !ahead.medium || !ahead.medium->scatters()) return true;
    wayOut_.reset();
    return aimedAt_ < 0;
}

template <bool TimeResolved, typename Beside>
bool PathVisitor<TimeResolved, Beside>::tooLate(const PathState& path) const {
    // Unwarped time starts where the camera's own specular chain ends, wherever that will be.
    if (!TimeResolved || !path.timed) return false;
    const Vec3f& position = path.ray.origin;
    if (context_->bound.mayArrive(position, path.time)) return false;
    const auto late = [&](const PathTarget* source) {
        return !source ||
               !context_->bound.beforeEnd(path.time, (source->vertex.position() - position).length(), source->start);
    };
    if constexpr (Beside::Balanced) {
        const TargetChoice& targets = beside_.trail->targets();
        return std::all_of(targets.singleDirections().begin(), targets.singleDirections().end(),
                           [&](size_t emitter) { return late(beside_.trail->target(emitter)); });
    }
    return late(source_);
}

template <bool TimeResolved, typename Beside>
bool PathVisitor<TimeResolved, Beside>::arrive(PathState& path, auto&, const Ahead& ahead, const Flight& flight) {
    if (tooLate(path)) return false;
    beside_.arrive(path, ahead, flight);
    if (flight.event == Flight::Event::Surface) {
        if (!inExpectation(path)) addEmission(path, *ahead.hit);
        if (limits().endsAtSurface(path.mediumScatters)) return false;
    }
    return limits().mayGoOn(path.interactions);
}

template <bool TimeResolved, typename Beside>
bool PathVisitor<TimeResolved, Beside>::vertex(PathState& path, auto& steps, const WalkVertex& at) {
    const bool connects = at.medium ? settings().volumeLightSampling
                                    : settings().lightSampling && (at.surface->bsdf->lobes() & lobe::Smooth) != 0;
    if (connects) {
        const Vertex vertex = at.connectible(scene(), TransportMode::Radiance);
        if constexpr (Beside::Balanced) {
            path.random.at(path.interactions, Draw::Light);
            const size_t emitter = beside_.trail->targets().choose(path.random.next1D());
            if (const PathTarget* target = beside_.trail->target(emitter))
                connectToTarget(path, vertex, *target, emitter);
        } else {
            // In sealed bodies no vertex is both smooth and in the open.
            if (orderCounts(path) && !context_->refracted) connectToLight(path, vertex);
            if (source_) connectToTarget(path, vertex, *source_);
        }
    }
    if (context_->refracted && at.medium) {
        sealed_ = SealedVertex{at.position, at.before, path.time, path.region, path.channels};
        aimThroughWall(path, steps, *at.medium);
    }
    if (record_) record_->add(path, at);
    return true;
}

template <bool TimeResolved, typename Beside>
void PathVisitor<TimeResolved, Beside>::leave(PathState& path, auto& steps, const WalkVertex& at, const Way& way) {
    beside_.leave(way);
    if (!context_->refracted || at.medium) return;
    // A way out of a body begins, or has ended.
    steps.lobes = lobe::All;
    const SurfaceHit& hit = at.surface->hit;
    if (sealed_ && way.lobe == lobe::SpecularTransmission) {
        const Region& inside = sealed_->region;
        if (&scene().primitives[hit.shape] == context_->refracted->boundary(inside.medium))
            wayOut_ = WayOut{*sealed_, at.before, context_->refracted->faceOf(inside.medium, hit.ng),
                             path.last.pdf * probabilityFlightExits(*scene().medium(inside), hit.t, sealed_->channels)};
    }
    sealed_.reset();
}

template <bool TimeResolved, typename Beside>
bool PathVisitor<TimeResolved, Beside>::sharesWithConnections(const PathState& path) const {
    using Kind = transport::LastVertex::Kind;
    switch (path.last.kind) {
    case Kind::Medium:
        return settings().volumeLightSampling;
    case Kind::Surface:
        return settings().lightSampling;
    case Kind::Start:
    case Kind::Specular:
        return false; // emitters seen in a mirror cannot be connected to
    }
    return false;
}

template <bool TimeResolved, typename Beside>
transport::TechniqueShare PathVisitor<TimeResolved, Beside>::shareOfMeeting(const PathState& path, int index,
                                                                            const SurfaceHit& hit,
                                                                            [[maybe_unused]] double time) const {
    if (!sharesWithConnections(path)) return {};
    const float direct = pdfDirect(scene().emitters[size_t(index)], path.last.position, hit.position, hit.ng);
    if constexpr (Beside::Balanced) {
        const float pdf = direct * beside_.trail->targets().probability(size_t(index));
        const float denser =
            fromMedium(path) && pdf > 0.0f ? beside_.trail->connectionsOverPlain(size_t(index), hit, time) : 1.0f;
        return transport::TechniqueShare::of({path.last.pdf, pdf}, {path.last.pdf, pdf * denser});
    }
    return {transport::powerHeuristic(path.last.pdf, direct * context_->lights.probability(index))};
}

template <bool TimeResolved, typename Beside>
void PathVisitor<TimeResolved, Beside>::addEmission(const PathState& path, const SurfaceHit& hit) const {
    if (hit.shape >= scene().primitives.size() || scene().primitives[hit.shape].emitter < 0) return;
    const int index = scene().primitives[hit.shape].emitter;
    const Emitter& emitter = scene().emitters[size_t(index)];
    const Rgb radiance = emittedRadiance(emitter, hit.uv, hit.ng, -path.ray.direction);
    // The light is no interaction of its own path.
    if (isBlack(radiance) || !limits().renders(path.interactions - 1) || !orderCounts(path)) return;
    const double time = path.time + emitter.emissionTime;
    if (Beside::Balanced && !sink_->mayCount(time)) return;
    const auto share = shareOfMeeting(path, index, hit, time);
    float weight = share.beside;
    if (weight == 0.0f) return;
    if (context_->refracted) weight *= refractedShare(index);
    LogRatio logRatio = 0.0f;
    if constexpr (Beside::Balanced) {
        const bool guided = !fromMedium(path) && beside_.trail->targets().probability(size_t(index)) > 0.0f;
        logRatio = guided ? beside_.trail->atLight(size_t(index), time) : StrategyBalance::Never;
        logRatio = logRatio.with(share);
    }
    sink_->add(path.throughput * radiance * weight, time, emitter, logRatio, Found::OnWay);
}

template <bool TimeResolved, typename Beside>
void PathVisitor<TimeResolved, Beside>::addEnvironment(const PathState& path) const {
    if (scene().infiniteEmitters.empty() || scene().medium(path.region) || !limits().renders(path.interactions) ||
        !orderCounts(path))
        return;
    const int index = scene().infiniteEmitters.back();
    const Emitter& emitter = scene().emitters[size_t(index)];
    float weight = 1.0f;
    if (sharesWithConnections(path))
        weight = transport::powerHeuristic(path.last.pdf, pdfDirectInfinite(emitter, path.ray.direction) *
                                                              context_->lights.probability(index));
    sink_->add(path.throughput * environmentRadiance(emitter, path.ray.direction) * weight, Infinity, emitter, 0.0f);
}

template <bool TimeResolved, typename Beside>
void PathVisitor<TimeResolved, Beside>::connectToLight(PathState& path, const Vertex& vertex) {
    path.random.at(path.interactions, Draw::Light);
    const auto choice = context_->lights.sample(path.random.next1D());
    if (!choice) return;
    const Emitter& emitter = *choice->emitter;
    const auto direct = sampleDirect(emitter, path.ray.origin, path.random.next2D());
    if (!direct) return;
    ++counters_->connections;
    if constexpr (TimeResolved)
        if (!context_->bound.mayConnect(path.time, direct->distance, emitter.emissionTime)) return;
    const auto connection =
        connector_.connect(vertex, path.throughput, transport::connectionEndpoint(*direct), counters_->shadowRays);
    if (!connection || !limits().renders(path.interactions + connection->crossings)) return;
    // Point-like emitters cannot be found by the walk: full weight.
    const float pdf = direct->pdf;
    const float weight =
        pdf > 0.0f ? transport::powerHeuristic(pdf * choice->probability, vertex.pdf(direct->direction)) : 1.0f;
    sink_->add(connection->throughput * (weight / choice->probability),
               path.time + connection->time + emitter.emissionTime, emitter, 0.0f);
}

template <bool TimeResolved, typename Beside>
void PathVisitor<TimeResolved, Beside>::connectToTarget(const PathState& path, const Vertex& vertex,
                                                        const PathTarget& target, [[maybe_unused]] size_t emitter) {
    if (!orderCounts(path, target.mediumScatters)) return;
    const auto way = transport::connectionSegment(path.ray.origin, target.vertex.position());
    if (!way) return;
    ++counters_->connections;
    if constexpr (TimeResolved)
        if (!context_->bound.mayConnect(path.time, way->distance, target.start)) return;
    const auto connection =
        connector_.connect(vertex, path.throughput, transport::connectionEndpoint(*way, target), counters_->shadowRays);
    if (!connection || !limits().renders(path.interactions + connection->crossings + target.interactions)) return;
    const double time = path.time + connection->time + target.start;
    float weight = 1.0f;
    LogRatio logRatio = 0.0f;
    if constexpr (Beside::Balanced) {
        logRatio = beside_.trail->atVertex(emitter, time, connection->crossings == 0);
        // Surfaces that shine can be met, too.
        const float denser = vertex.surface() ? 1.0f : beside_.trail->connectionsOverPlain(emitter, time);
        const auto share = target.shareOfConnection(path.ray.origin, vertex.pdf(way->direction), denser);
        weight = share.beside;
        logRatio = logRatio.with(share);
    }
    sink_->add(connection->throughput * weight, time, *target.emitter, logRatio, Found::OnWay);
}

template <bool TimeResolved, typename Beside>
void PathVisitor<TimeResolved, Beside>::aimThroughWall(const PathState& path, const auto& steps,
                                                       const Medium& medium) const {
    const RefractiveConnections& refracted = *context_->refracted;
    if (path.flights + 1 > medium.maxBounces) return;
    transport::Walk aimed{path, steps, *this};
    aimed.path.random = path.random.branch(RandomStream::Aimed, uint64_t(path.interactions));
    const auto drawn = refracted.draw(*sealed_, aimed.path.random);
    if (!drawn) return;
    aimed.path.ray = Ray{path.ray.origin, drawn->direction};
    ++counters_->rays;
    ++counters_->refracted;
    const Ahead ahead{true, &medium, scene().geometry->intersect(aimed.path.ray)};
    if (!ahead.hit || &scene().primitives[ahead.hit->shape] != refracted.boundary(path.region.medium) ||
        refracted.faceOf(path.region.medium, ahead.hit->ng) != drawn->face)
        return;
    const float density = refracted.density(*sealed_, drawn->direction, drawn->face, drawn->emitter);
    if (!(density > 0.0f)) return;
    const float reach = ahead.reach(), exits = probabilityFlightExits(medium, reach, path.channels);
    const float phase = medium.phase.eval(sealed_->before, drawn->direction);
    const float share = transport::balance(density, phase * exits);
    aimed.visitor.aimedAt_ = drawn->emitter;
    aimed.visitor.record_ = nullptr;
    aimed.steps.lobes = lobe::SpecularTransmission;
    if (aimed.arrive(ahead, {Flight::Event::Surface, reach,
                             medium.transmittance(reach) * (phase * drawn->weight * share / density)}))
        aimed.run();
}

template <bool TimeResolved, typename Beside>
float PathVisitor<TimeResolved, Beside>::refractedShare(int emitter) const {
    if (aimedAt_ >= 0) return emitter == aimedAt_ ? 1.0f : 0.0f;
    if (!wayOut_) return 1.0f;
    const float density = context_->refracted->density(wayOut_->from, wayOut_->direction, wayOut_->face, emitter);
    return transport::balance(wayOut_->pdf, density);
}

template <bool TimeResolved, typename Beside>
struct PathVisitor<TimeResolved, Beside>::View : transport::VisitorBase {
    const PathVisitor* paths;
    bool throughMedium = false;

    explicit View(const PathVisitor* of) : paths(of) {}
    [[nodiscard]] bool mayGoOn(const PathState& path) const { return paths->limits().mayGoOn(path.interactions); }
    bool ahead(PathState& path, auto&, const Ahead& ahead) {
        throughMedium |= ahead.medium != nullptr;
        return !ahead.medium || !ahead.medium->scatters() || transport::BounceLimits::fly(path.flights, *ahead.medium);
    }
    void escape(PathState& path) {
        counting([&] { paths->addEnvironment(path); });
    }
    bool arrive(PathState& path, auto&, const Ahead& ahead, const Flight&) {
        counting([&] { paths->addEmission(path, *ahead.hit); });
        return !paths->limits().endsAtSurface(path.mediumScatters);
    }

  private:
    /// What counts of the light that `add` adds, if it has come through a medium.
    void counting(const auto& add) const {
        const uint64_t before = paths->counters_->arrivals;
        add();
        if (throughMedium) paths->counters_->inView += paths->counters_->arrivals - before;
    }
};

template <bool TimeResolved, typename Beside>
void PathVisitor<TimeResolved, Beside>::addLightsInView(const PathState& start) const {
    transport::Walk walk{
        start, transport::StraightSteps<TransportMode::Radiance>({scene(), *counters_, context_->watch}), View(this)};
    walk.steps.lobes = lobe::Forward;
    walk.run();
}

template <bool TimeResolved, bool Media>
void tracePath(const PathContext& context, PixelAccumulator& sink, PathCounters& counters, const Sampler& sampler,
               const PathTarget* source, const Ray& ray) {
    const Scene& scene = context.scene;
    ++counters.paths;
    using Steps = WindowedSteps<transport::PlainOptions{.media = Media, .timed = TimeResolved}>;
    const PathState start{
        .random = sampler, .ray = ray, .region = scene.cameraRegion, .timed = !scene.transport.cameraUnwarped};
    PathVisitor<TimeResolved> visitor(context, sink, counters, source);
    if (context.lightsInView) visitor.addLightsInView(start);
    transport::Walk walk{start, Steps({scene, counters, context.watch}, context.windows), visitor};
    walk.steps.roulette = context.settings.russianRoulette && !context.windows;
    walk.run();
}

void tracePlainBesideGuided(const PathContext& context, const BesideGuided& beside, PixelAccumulator& sink,
                            PathCounters& counters, const Sampler& sampler, const Ray& ray) {
    const Scene& scene = context.scene;
    ++counters.paths;
    using Steps = transport::PlainSteps<transport::PlainOptions{}>;
    transport::Walk walk{
        PathState{
            .random = sampler, .ray = ray, .region = scene.cameraRegion, .timed = !scene.transport.cameraUnwarped},
        Steps({scene, counters, context.watch}),
        PathVisitor<true, BesideGuided>(context, sink, counters, nullptr, beside)};
    walk.steps.roulette = context.settings.russianRoulette;
    walk.run();
}

template void tracePath<false, false>(const PathContext&, PixelAccumulator&, PathCounters&, const Sampler&,
                                      const PathTarget*, const Ray&);
template void tracePath<false, true>(const PathContext&, PixelAccumulator&, PathCounters&, const Sampler&,
                                     const PathTarget*, const Ray&);
template void tracePath<true, false>(const PathContext&, PixelAccumulator&, PathCounters&, const Sampler&,
                                     const PathTarget*, const Ray&);
template void tracePath<true, true>(const PathContext&, PixelAccumulator&, PathCounters&, const Sampler&,
                                    const PathTarget*, const Ray&);

} // namespace tungsten::path
