// The walk's vertices: directions drawn for the connections that follow.

#include "path/guided/GuidedPathWalk.h"
#include "path/techniques/ControlVertices.h"
#include "path/techniques/EmitterConnections.h"
#include "path/techniques/LightVertexConnections.h"
#include "path/techniques/ReflectedConnections.h"

namespace tungsten::path {

namespace {

/// A surface whose lobes are all smooth and reflect. Directions into it stand for absorption: their density is 0.
struct SurfaceScatterer {
    const SurfaceInteraction& surface;
    Sampler& sampler; ///< chooses among lobes

    [[nodiscard]] darts::Vec3 sample(float u, float v) const {
        const BsdfRandom random{{u, v}, sampler.next1D()};
        const auto sample = surface.bsdf->sample(surface.query(TransportMode::Radiance), surface.wi, random);
        return darts::vec3(sample ? surface.frame.toWorld(sample->wo).normalized() : -surface.frame.n);
    }
    [[nodiscard]] float pdf(const darts::Vec3& direction) const {
        return surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi,
                                 surface.frame.toLocal(darts::to<Vec3f>(direction)));
    }
};

} // namespace

template <typename Scatterer>
darts::DirectionSample GuidedPathWalk::sampleDirection(const darts::Guide& guide, const Scatterer& scatterer) {
    transport::GuidedSteps& step = path_.step;
    const bool lengthFirst = guide.settings().lengthFirst, elliptical = guide.settings().elliptical;
    Sampler& sampler = path_.state.sampler;
    sampler.at(path_.state.interactions, Draw::Connection);
    if (lengthFirst) step.connect(path_.drawConnection(guide, step.residual()));
    sampler.at(path_.state.interactions, Draw::GuidedDirection);
    const darts::DirectionSample sample =
        step.sampleDirection(guide, scatterer, darts::NoView{}, [this] { return path_.next(); });
    if (lengthFirst && elliptical)
        step.place({guide, sample.h, path_.state.time, path_.sharesConnections()});
    else
        step.startWay();
    return sample;
}

template <typename GoOn>
void GuidedPathWalk::split(const darts::Guide& guide, GoOn&& goOn) {
    const int copies = path_.step.copies(guide);
    path_.state.throughput = path_.state.throughput / float(copies);
    for (int i = 1; i < copies; ++i) {
        GuidedPathWalk copy(*this);
        copy.path_.state.sampler = path_.state.sampler.copy(path_.state.interactions, i);
        goOn(copy);
    }
}

void GuidedPathWalk::arrive(float pdf, const Vec3f& normal) {
    path_.approach.reset();
    if (path_.last.usesReflectedLight() && pdf > 0.0f) path_.approach = Approach{pdf, normal};
    path_.last.caches = LastVertex::Caches::None;
}

void GuidedPathWalk::connectToLightPaths(const transport::Vertex& here) {
    const Medium* medium = scene_.medium(path_.state.region);
    const LightPaths& lightPaths = context_.lightPaths;
    const LightVertexCache* vertices = lightPaths.vertices(path_.target->index);
    if (!vertices || !path_.mayFly(medium)) return;
    path_.last.caches = LastVertex::Caches::LightVertices;
    LightVertexConnections::connect(path_, here, *vertices);
    // Wherever reflected light ends, a walk would connect to light vertices.
    const ReflectedLightCache* reflected = lightPaths.reflected(path_.target->index);
    if (!reflected || !medium || path_.state.flights + 1 >= medium->maxBounces) return;
    path_.last.caches = LastVertex::Caches::ReflectedLightToo;
    ReflectedConnections::connect(path_, here, *reflected);
}

bool GuidedPathWalk::scatterInMedium(const Medium& medium, float distance) {
    CameraPath& state = path_.state;
    state.counters.scatter(medium);
    state.time = state.timeAfter(distance);
    ++state.interactions;
    ++state.mediumScatters;
    state.scattered = true;
    path_.last.kind = LastVertex::Kind::Medium;
    const Vec3f before = state.ray.direction;
    const bool elliptical = path_.guideOf(state.region).settings().elliptical;
    const float controlShare = elliptical ? ControlVertices::share(path_, medium, distance) : 0.0f;
    state.ray = Ray{state.ray.at(distance), before};
    const float flight = path_.last.usesReflectedLight() ? context_.lightPaths.flights().pdf(distance) : 0.0f;
    arrive(path_.last.pdf * flight / sqr(distance), Vec3f(0.0f));
    lookAhead(state.ray.origin);
    if (!path_.step.reachable().alive()) return false;
    lookOut({state.ray.origin});
    ConnectionsFromMedia::connect(path_, medium, controlShare);
    const darts::Guide& guide = path_.guideOf(state.region);
    if (state.interactions + 1 >= scene_.transport.maxBounces) return false;
    connectToLightPaths({medium, state.ray.origin, before, state.region});
    if (!survives(guide)) return false;
    split(guide, [&](GuidedPathWalk& copy) {
        if (copy.leaveInMedium(medium, before)) copy.goOn();
    });
    return leaveInMedium(medium, before);
}

bool GuidedPathWalk::leaveInMedium(const Medium& medium, const Vec3f& before) {
    CameraPath& state = path_.state;
    const darts::Guide& guide = path_.guideOf(state.region);
    path_.step.startWay();
    if (!path_.step.residual().alive() || guide.settings().direction == darts::Direction::Phase) {
        state.sampler.at(state.interactions, Draw::Direction);
        state.ray.direction = medium.phase.sample(before, state.sampler.next2D());
        path_.last.pdf = medium.phase.pdf(before, state.ray.direction);
        return true;
    }
    const darts::DirectionSample sample = sampleDirection(guide, darts::PhaseScatterer{medium.phase, before});
    state.ray.direction = darts::to<Vec3f>(sample.direction);
    path_.last.pdf = medium.phase.eval(before, state.ray.direction);
    state.throughput = state.throughput * (path_.last.pdf * sample.inversePdf);
    return !isBlack(state.throughput);
}

bool GuidedPathWalk::scatterOnSurface(const SurfaceHit& hit) {
    CameraPath& state = path_.state;
    ++state.counters.surfaceEvents;
    state.time = state.timeAfter(hit.t);
    state.flights = 0;
    if (state.timed()) {
        lookAhead(hit.position);
        if (!path_.step.reachable().alive()) return false;
    }
    if (++state.interactions >= scene_.transport.maxBounces) return false;
    // The format ends such a path at any surface, index-matched ones included.
    if (context_.settings.limits.endsAtSurface(state.mediumScatters)) return false;
    const SurfaceInteraction surface = makeInteraction(scene_, hit, state.ray.direction);
    const transport::Vertex vertex = path_.vertexOn(surface);
    const darts::Guide* guide = path_.guideFor(vertex, -state.ray.direction);
    arrive(guide ? ConnectionsFromSurfaces::density(path_, vertex, hit.t) : 0.0f,
           state.ray.direction.dot(hit.ng) < 0.0f ? hit.ng : -hit.ng);
    return guide ? leaveGuided(vertex, *guide) : leavePlainly(surface);
}

bool GuidedPathWalk::leaveGuided(const transport::Vertex& here, const darts::Guide& guide) {
    const SurfaceInteraction& surface = *here.surface();
    CameraPath& state = path_.state;
    state.scattered = true;
    state.region = regionBeyond(surface, -state.ray.direction, state.region);
    lookAhead(surface.hit.position);
    path_.last.kind = LastVertex::Kind::Surface;
    path_.last.position = surface.hit.position;
    state.ray = Ray{surface.hit.position, state.ray.direction};
    if (path_.step.residual().alive()) lookOut({surface.hit.position, surface.hit.margin()});
    connectToLightPaths(here);
    if (!path_.step.residual().alive()) return leavePlainly(surface);
    if (!survives(guide)) return false;
    path_.step.startWay();
    state.counters.leave(lobe::DiffuseReflection);
    const darts::DirectionSample sample = sampleDirection(guide, SurfaceScatterer{surface, state.sampler});
    state.ray = surface.hit.leave(darts::to<Vec3f>(sample.direction));
    state.throughput = state.throughput * (here.scattering(state.ray.direction) * sample.inversePdf);
    path_.last.pdf = here.pdf(state.ray.direction);
    return !isBlack(state.throughput);
}

bool GuidedPathWalk::leavePlainly(const SurfaceInteraction& surface) {
    CameraPath& state = path_.state;
    state.sampler.at(state.interactions, Draw::Direction);
    const auto exit =
        sampleExit(surface, surface.query(TransportMode::Radiance), scene_.transport.consistencyChecks, state.sampler);
    if (!exit) return false;
    state.throughput = state.throughput * exit->weight;
    if (isBlack(state.throughput)) return false;
    state.counters.leave(exit->lobe);
    if ((exit->lobe & lobe::Smooth) != 0) {
        state.scattered = true;
        path_.last.kind = LastVertex::Kind::Surface;
        path_.last.pdf = exit->pdf;
        path_.last.position = surface.hit.position;
    } else if (!exit->straight()) {
        path_.last.kind = LastVertex::Kind::Specular;
    }
    passBoundary(surface, exit->direction, exit->straight());
    state.ray = surface.hit.leave(exit->direction);
    if (state.timed()) lookAhead(state.ray.origin);
    return true;
}

/// Into the region ahead. A connection drawn before goes on through a boundary that light passes straight at its speed.
void GuidedPathWalk::passBoundary(const SurfaceInteraction& surface, const Vec3f& direction, bool straight) {
    const float speed = path_.state.region.speed;
    path_.state.region = regionBeyond(surface, direction, path_.state.region);
    if (straight && path_.state.region.speed == speed)
        path_.step.passBoundary(surface.hit.t);
    else
        path_.step.startWay();
}

} // namespace tungsten::path
