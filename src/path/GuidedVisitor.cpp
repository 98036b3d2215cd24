#include "path/GuidedVisitor.h"

#include "path/techniques/ControlVertices.h"
#include "path/techniques/EmitterConnections.h"
#include "path/techniques/LightPaths.h"
#include "path/techniques/LightVertexConnections.h"
#include "path/techniques/ReflectedConnections.h"

namespace tungsten::path {

using transport::Ahead;
using transport::Flight;
using transport::WalkVertex;
using Passage = StepsToEmitter::Passage;

float GuidedPath::logRatioOnSurface(LobeMask lobes) const {
    const LightPaths& lightPaths = context.lightPaths;
    if (!steps.hasDensities() || !lightPaths.vertices(target().index)) return steps.logRatioOnSurface();
    return lightPaths.reflected(target().index) && reflectsSharply(lobes) ? ratios.before : ratios.there;
}

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

void GuidedVisitor::approach(float pdf, const Vec3f& normal) {
    approach_.reset();
    if (caches_ == Caches::ReflectedLightToo && pdf > 0.0f) approach_ = Approach{pdf, normal};
    caches_ = Caches::None;
}

bool GuidedVisitor::arrive(PathState& path, StepsToEmitter& steps, const Ahead& ahead, const Flight& flight) {
    if (flight.event == Flight::Event::Surface) {
        ratios_.before = std::exchange(ratios_.there, path.logRatio);
        // The format ends such a path at any surface, index-matched ones included.
        return limits().mayGoOn(path.interactions) && !limits().endsAtSurface(path.mediumScatters);
    }
    const Medium& medium = *ahead.medium;
    ratios_.before = std::exchange(ratios_.there, path.logRatio);
    const GuidedPath guided = at(path, steps);
    const bool connects = !steps.hasDensities() || guided.wayInTime(path.ray.origin, path.time);
    inMedium_ = connects ? ControlVertices::ending(guided, medium, flight.distance) : StepsToEmitter::InMedium{1.0f};
    const float ends =
        caches_ == Caches::ReflectedLightToo ? context_->lightPaths.flights().pdf(flight.distance) : 0.0f;
    approach(path.last.pdf * ends / sqr(flight.distance), Vec3f(0.0f));
    return true;
}

bool GuidedVisitor::vertex(PathState& path, StepsToEmitter& steps, const WalkVertex& vertex) {
    const transport::Vertex here = vertex.connectible(context_->scene, TransportMode::Radiance);
    if (vertex.medium) {
        ConnectionsFromMedia::connect(at(path, steps), *vertex.medium, inMedium_);
        // Where lights that are met after a medium have been connected to, what is found next has a further vertex.
        if (!steps.hasDensities() && !limits().mayGoOn(path.interactions + 1)) return false;
    } else {
        const SurfaceHit& hit = vertex.surface->hit;
        approach(steps.surfaceGuide() ? ConnectionsFromSurfaces::density(at(path, steps), here, hit.t) : 0.0f,
                 vertex.before.dot(hit.ng) < 0.0f ? hit.ng : -hit.ng);
        if (!steps.surfaceGuide()) return true;
    }
    connectToLightPaths(at(path, steps), here);
    return true;
}

void GuidedVisitor::connectToLightPaths(const GuidedPath& path, const transport::Vertex& here) {
    const Medium* medium = path.scene().medium(path.state.region);
    const LightPaths& lightPaths = context_->lightPaths;
    const LightVertexCache* vertices = lightPaths.vertices(path.target().index);
    if (!vertices || !path.mayFly(medium)) return;
    caches_ = Caches::LightVertices;
    LightVertexConnections::connect(path, here, *vertices);
    // Wherever reflected light ends, a walk would connect to light vertices.
    const ReflectedLightCache* reflected = lightPaths.reflected(path.target().index);
    if (!reflected || !medium || path.state.flights + 1 >= medium->maxBounces) return;
    caches_ = Caches::ReflectedLightToo;
    ReflectedConnections::connect(path, here, *reflected);
}

void traceGuidedPath(const GuidedContext& context, PixelSink& sink, PathCounters& counters, const Sampler& sampler,
                     PathTarget target, const Ray& ray) {
    const Scene& scene = context.scene;
    ++counters.paths;
    transport::Walk walk{
        PathState{
            .random = sampler, .ray = ray, .region = scene.cameraRegion, .timed = !scene.transport.cameraUnwarped},
        StepsToEmitter(context, counters, target), GuidedVisitor(context, sink, counters)};
    walk.run();
}

} // namespace tungsten::path
