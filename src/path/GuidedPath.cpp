#include "path/GuidedPath.h"

#include "path/techniques/ControlVertices.h"
#include "path/techniques/EmitterConnections.h"
#include "path/techniques/GlossyLightVertices.h"
#include "path/techniques/LightCaches.h"
#include "path/techniques/LightVertices.h"

namespace tungsten::path {

using transport::Ahead;
using transport::Flight;
using transport::WalkVertex;
using Passage = StepsToEmitter::Passage;

void WayBehind::approachBy(float pdf, const Vec3f& normal) {
    approach.reset();
    if (caches == Caches::GlossyVerticesToo && pdf > 0.0f) approach = Approach{pdf, normal};
    caches = Caches::None;
}

void WayBehind::approachInMedium(const GuidedContext& context, const PathState& path, float distance) {
    const float ends = caches == Caches::GlossyVerticesToo ? context.lightCaches.flights().pdf(distance) : 0.0f;
    approachBy(path.last.pdf * ends / sqr(distance), Vec3f(0.0f));
}

void WayBehind::approachOnSurface(const StepsToEmitter& steps, const PathState& path, const transport::Vertex& here,
                                  const SurfaceHit& hit) {
    const Vec3f& before = path.ray.direction;
    approachBy(steps.surfaceGuide() ? here.areaDensity(path.last.pdf, before, hit.t) : 0.0f,
               before.dot(hit.ng) < 0.0f ? hit.ng : -hit.ng);
}

void WayBehind::connect(const GuidedContext& context, int emitter, const PathState& path) {
    const Medium* medium = context.scene.medium(path.region);
    if (!context.lightCaches.vertices(emitter) || (medium && path.flights >= medium->maxBounces)) return;
    // Wherever reflected light ends, a walk would connect to light vertices.
    const bool reflected = context.lightCaches.reflected(emitter) && medium && path.flights + 1 < medium->maxBounces;
    caches = reflected ? Caches::GlossyVerticesToo : Caches::LightVertices;
}

float GuidedPath::logRatioByLightCaches(const transport::Vertex& surface, float shareOfWalk) const {
    constexpr float Least = 1e-30f; // of what walks hardly find
    const bool reflected = GlossyVertexConnections::mayFind(*this, surface);
    return (reflected ? behind.ratios.before : behind.ratios.there) - std::log(std::max(shareOfWalk, Least));
}

// ---- The visitor

bool GuidedVisitor::ahead(PathState& path, StepsToEmitter& steps, const Ahead& ahead) {
    const GuidedPath guided = at(path, steps);
    switch (steps.passage()) {
    case Passage::Empty:
        break;
    case Passage::Medium:
        ControlVertices::sample(guided, ahead);
        break;
    case Passage::Untimed:
        ControlVertices::sampleUntimed(guided, ahead);
        break;
    }
    if (!ahead.hit) return true;
    // The surface ahead, in expectation: whether or not the walk goes there.
    const Rgb reaching = ahead.medium ? path.throughput * ahead.medium->transmittance(ahead.reach()) : path.throughput;
    if (isBlack(reaching)) return true;
    EmittersMet::add(guided, *ahead.hit, reaching);
    if ((context_->scene.bsdfOf(*ahead.hit).lobes() & lobe::Smooth) != 0)
        ConnectionsFromSurfaces::connect(guided, *ahead.hit, reaching);
    return true;
}

bool GuidedVisitor::arrive(PathState& path, StepsToEmitter& steps, const Ahead& ahead, const Flight& flight) {
    behind_.arrive(path.logRatio);
    // The format ends such a path at any surface, index-matched ones included.
    if (flight.event == Flight::Event::Surface)
        return limits().mayGoOn(path.interactions) && !limits().endsAtSurface(path.mediumScatters);
    const GuidedPath guided = at(path, steps);
    inMedium_ = {0.0f, 1.0f};
    if (steps.ownVerticesConnect() && (!steps.hasDensities() || guided.wayInTime(path.ray.origin, path.time)))
        inMedium_ = ControlVertices::ending(guided, *ahead.medium, flight.distance);
    behind_.approachInMedium(*context_, path, flight.distance);
    return true;
}

bool GuidedVisitor::vertex(PathState& path, StepsToEmitter& steps, const WalkVertex& vertex) {
    const transport::Vertex here = vertex.connectible(context_->scene, TransportMode::Radiance);
    if (vertex.medium) {
        ConnectionsFromMedia::connect(at(path, steps), *vertex.medium, inMedium_);
        // Where lights that are met after a medium have been connected to, what is found next has a further vertex.
        if (!steps.hasDensities() && !limits().mayGoOn(path.interactions + 1)) return false;
    } else {
        behind_.approachOnSurface(steps, path, here, vertex.surface->hit);
        if (!steps.surfaceGuide()) return true;
    }
    connectToLightCaches(at(path, steps), here);
    return true;
}

void GuidedVisitor::connectToLightCaches(const GuidedPath& path, const transport::Vertex& here) {
    const int emitter = path.target().index;
    behind_.connect(*context_, emitter, path.state);
    if (behind_.caches == Caches::None) return;
    LightVertexConnections::connect(path, here, *context_->lightCaches.vertices(emitter));
    if (behind_.caches == Caches::GlossyVerticesToo)
        GlossyVertexConnections::connect(path, here, *context_->lightCaches.reflected(emitter));
}

void traceGuidedPath(const GuidedContext& context, PixelAccumulator& sink, PathCounters& counters,
                     const Sampler& sampler, const PathTarget& target, const Ray& ray, size_t window) {
    const Scene& scene = context.scene;
    ++counters.paths;
    transport::Walk walk{
        PathState{
            .random = sampler, .ray = ray, .region = scene.cameraRegion, .timed = !scene.transport.cameraUnwarped},
        StepsToEmitter(context, counters, target, window), GuidedVisitor(context, sink, counters)};
    walk.run();
}

} // namespace tungsten::path
