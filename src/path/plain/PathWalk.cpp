#include "path/plain/PathWalk.h"

#include "path/Tuning.h"

#include "transport/Balance.h"
#include "transport/Roulette.h"

namespace tungsten::path {

using transport::Vertex;

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::run(Ray ray) {
    path_.ray = ray;
    path_.region = scene_.cameraRegion;
    ++path_.counters.paths;
    goOn();
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::goOn() {
    while (path_.interactions < scene_.transport.maxBounces) {
        path_.counters.step(watch_);
        if constexpr (Media) {
            if (const Medium* medium = scene_.medium(path_.region)) {
                if (!crossMedium(*medium)) return;
                continue;
            }
        }
        ++path_.counters.rays;
        if (!arriveAt(scene_.geometry->intersect(path_.ray))) return;
    }
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::crossMedium(const Medium& medium) {
    if (medium.scatters() && ++path_.flights > medium.maxBounces) return false;
    if (refracted_ && medium.scatters()) {
        if (aimedAt_ >= 0) return false;
        wayOut_.reset();
    }
    // The free flight comes first: the ray need not look beyond its collision.
    path_.sampler.at(path_.interactions + 1, Draw::Flight);
    const FlightSample flight = sampleFlight(medium, Infinity, path_.sampler);
    path_.ray.tMax = flight.distance;
    path_.counters.fly(medium);
    ++path_.counters.rays;
    const auto hit = scene_.geometry->intersect(path_.ray);
    if (!hit && !flight.exited) {
        path_.throughput = path_.throughput * flight.weight;
        return scatterInMedium(medium, flight.distance);
    }
    const float reach = hit ? hit->t : Infinity;
    path_.throughput = path_.throughput * (medium.transmittance(reach) / probabilityFlightExits(medium, reach));
    return arriveAt(hit);
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::arriveAt(const std::optional<SurfaceHit>& hit) {
    if (hit) return !isBlack(path_.throughput) && scatterOnSurface(*hit);
    addEnvironment();
    return false;
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::advanceClock(float length) {
    if constexpr (TimeResolved)
        if (path_.timed()) path_.time += double(length) / double(path_.region.speed);
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::tooLate(const Vec3f& position) const {
    // Unwarped time starts where the camera's own specular chain ends, wherever that will be.
    if constexpr (TimeResolved)
        if (path_.timed()) {
            if (bound_.mayArrive(position, path_.time)) return false;
            return !source_ ||
                   !bound_.beforeEnd(path_.time, (source_->vertex.position() - position).length(), source_->start);
        }
    return false;
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::continueRoulette() {
    if (!settings_.russianRoulette) return true;
    path_.sampler.at(path_.interactions, Draw::Roulette);
    return transport::survivesRoulette(path_.throughput, path_.interactions, path_.sampler);
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::scatterInMedium(const Medium& medium, float distance) {
    path_.counters.scatter(medium);
    advanceClock(distance);
    ++path_.interactions;
    ++path_.mediumScatters;
    path_.scattered = true;
    vertex_ = path_.ray.at(distance);
    if (tooLate(vertex_) || path_.interactions >= scene_.transport.maxBounces) return false;
    const Vec3f before = path_.ray.direction;
    if (settings_.volumeLightSampling) connect({medium, vertex_, before, path_.region});
    path_.sampler.at(path_.interactions, Draw::Direction);
    path_.ray = Ray{vertex_, medium.phase.sample(before, path_.sampler.next2D())};
    directionPdf_ = medium.phase.pdf(before, path_.ray.direction);
    weighted_ = settings_.volumeLightSampling;
    if (refracted_) {
        sealed_ = SealedVertex{vertex_, before, path_.time, path_.region};
        aimThroughWall(medium);
    }
    return continueRoulette();
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::scatterOnSurface(const SurfaceHit& hit) {
    ++path_.counters.surfaceEvents;
    advanceClock(hit.t);
    path_.flights = 0;
    if (tooLate(hit.position)) return false;
    if (hit.shape < scene_.primitives.size() && scene_.primitives[hit.shape].emitter >= 0) addEmission(hit);
    if (++path_.interactions >= scene_.transport.maxBounces) return false;
    if (settings_.limits.endsAtSurface(path_.mediumScatters)) return false;

    const SurfaceInteraction surface = makeInteraction(scene_, hit, path_.ray.direction);
    const LobeMask lobes = surface.bsdf->lobes();
    if (settings_.lightSampling && (lobes & lobe::Smooth) != 0)
        connect({scene_, surface, path_.ray.direction, TransportMode::Radiance, path_.region});
    path_.sampler.at(path_.interactions, Draw::Direction);
    const auto exit = sampleExit(surface, surface.query(TransportMode::Radiance, onward_),
                                 scene_.transport.consistencyChecks, path_.sampler);
    if (!exit) return false;
    path_.throughput = path_.throughput * exit->weight;
    if (isBlack(path_.throughput)) return false;
    path_.counters.leave(exit->lobe);
    if (refracted_) passWall(hit, exit->lobe);
    if ((exit->lobe & lobe::Smooth) != 0) {
        path_.scattered = true;
        weighted_ = settings_.lightSampling;
        directionPdf_ = exit->pdf;
        vertex_ = hit.position;
    } else if (!exit->straight()) {
        weighted_ = false; // emitters seen in a mirror cannot be connected to
    }
    path_.region = regionBeyond(surface, exit->direction, path_.region);
    path_.ray = hit.leave(exit->direction);
    return continueRoulette();
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::addEmission(const SurfaceHit& hit) {
    const int index = scene_.primitives[hit.shape].emitter;
    const Emitter& emitter = scene_.emitters[size_t(index)];
    const Rgb radiance = emittedRadiance(emitter, hit.uv, hit.ng, -path_.ray.direction);
    if (isBlack(radiance) || !rendered(path_.interactions) || !orderCounts()) return;
    float weight = 1.0f;
    if (weighted_) {
        const float lightPdf = pdfDirect(emitter, vertex_, hit.position, hit.ng) * lights_.probability(index);
        weight = transport::powerHeuristic(directionPdf_, lightPdf);
    }
    if (refracted_) weight *= refractedShare(index);
    path_.sink.add(path_.throughput * radiance * weight, path_.time + emitter.emissionTime, emitter);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::aimThroughWall(const Medium& medium) {
    if (path_.flights + 1 > medium.maxBounces) return;
    Sampler aimed = path_.sampler.branch(RandomStream::Aimed, uint64_t(path_.interactions));
    const auto drawn = refracted_->draw(*sealed_, aimed);
    if (!drawn) return;
    PathWalk other(*this);
    other.path_.sampler = aimed;
    other.follow(*drawn, medium);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::follow(const RefractedLight::Drawn& drawn, const Medium& medium) {
    path_.ray = Ray{vertex_, drawn.direction};
    ++path_.counters.rays;
    ++path_.counters.refracted;
    const auto hit = scene_.geometry->intersect(path_.ray);
    const Primitive* boundary = refracted_->boundary(path_.region.medium);
    if (!hit || &scene_.primitives[hit->shape] != boundary ||
        refracted_->faceOf(path_.region.medium, hit->ng) != drawn.face)
        return;
    const float density = refracted_->density(*sealed_, drawn.direction, drawn.face, drawn.emitter);
    if (!(density > 0.0f)) return;
    const float phase = medium.phase.eval(sealed_->before, drawn.direction);
    const float met = phase * probabilityFlightExits(medium, hit->t);
    const float share = transport::balance(tuning::RefractedGain * density, met);
    path_.throughput = path_.throughput * (medium.transmittance(hit->t) * (phase * drawn.weight * share / density));
    aimedAt_ = drawn.emitter;
    onward_ = lobe::SpecularTransmission;
    if (arriveAt(hit)) goOn();
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::passWall(const SurfaceHit& hit, LobeMask lobe) {
    onward_ = lobe::All;
    if (sealed_ && lobe == lobe::SpecularTransmission) {
        const int medium = sealed_->region.medium;
        if (&scene_.primitives[hit.shape] == refracted_->boundary(medium))
            wayOut_ = WayOut{*sealed_, path_.ray.direction, refracted_->faceOf(medium, hit.ng),
                             directionPdf_ * probabilityFlightExits(*scene_.medium(sealed_->region), hit.t)};
    }
    sealed_.reset();
}

template <bool TimeResolved, bool Media>
float PathWalk<TimeResolved, Media>::refractedShare(int emitter) const {
    if (aimedAt_ >= 0) return emitter == aimedAt_ ? 1.0f : 0.0f;
    if (!wayOut_) return 1.0f;
    const float density = refracted_->density(wayOut_->from, wayOut_->direction, wayOut_->face, emitter);
    return transport::balance(wayOut_->pdf, tuning::RefractedGain * density);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::addEnvironment() {
    if (scene_.infiniteEmitters.empty() || scene_.medium(path_.region) || !rendered(path_.interactions) ||
        !orderCounts())
        return;
    const int index = scene_.infiniteEmitters.back();
    const Emitter& emitter = scene_.emitters[size_t(index)];
    float weight = 1.0f;
    if (weighted_)
        weight = transport::powerHeuristic(directionPdf_, pdfDirectInfinite(emitter, path_.ray.direction) *
                                                              lights_.probability(index));
    path_.sink.add(path_.throughput * environmentRadiance(emitter, path_.ray.direction) * weight, Infinity, emitter);
}

template <bool TimeResolved, bool Media>
auto PathWalk<TimeResolved, Media>::sampleLight(const Vec3f& position) -> std::optional<LightSample> {
    path_.sampler.at(path_.interactions, Draw::Light);
    const auto choice = lights_.sample(path_.sampler.next1D());
    if (!choice) return std::nullopt;
    const auto direct = sampleDirect(*choice->emitter, position, path_.sampler.next2D());
    if (!direct) return std::nullopt;
    ++path_.counters.connections;
    if constexpr (TimeResolved)
        if (!bound_.mayConnect(path_.time, direct->distance, choice->emitter->emissionTime)) return std::nullopt;
    return LightSample{*choice->emitter, *direct, choice->probability};
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectToLight(const Vertex& vertex) {
    const auto light = sampleLight(vertex.position());
    if (!light) return;
    const auto connection = connector_.connect(vertex, path_.throughput, transport::connectionEnd(light->direct),
                                               path_.counters.shadowRays);
    if (!connection || !rendered(path_.interactions + connection->crossings)) return;
    // Point-like emitters cannot be found by the walk: full weight.
    const float pdf = light->direct.pdf;
    const float weight =
        pdf > 0.0f ? transport::powerHeuristic(pdf * light->probability, vertex.pdf(light->direct.direction)) : 1.0f;
    path_.sink.add(connection->throughput * (weight / light->probability),
                   path_.time + connection->time + light->emitter.emissionTime, light->emitter);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectToSource(const Vertex& vertex) {
    if (!orderCounts(source_->mediumScatters)) return;
    const auto way = transport::straightWay(vertex.position(), source_->vertex.position());
    if (!way) return;
    ++path_.counters.connections;
    if constexpr (TimeResolved)
        if (!bound_.mayConnect(path_.time, way->distance, source_->start)) return;
    const auto connection = connector_.connect(vertex, path_.throughput, transport::connectionEnd(*way, *source_),
                                               path_.counters.shadowRays);
    if (!connection || !rendered(path_.interactions + connection->crossings + source_->interactions)) return;
    path_.sink.add(connection->throughput, path_.time + connection->time + source_->start, *source_->emitter);
}

template class PathWalk<false, false>;
template class PathWalk<false, true>;
template class PathWalk<true, false>;
template class PathWalk<true, true>;

} // namespace tungsten::path
