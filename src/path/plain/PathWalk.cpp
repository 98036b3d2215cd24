#include "path/plain/PathWalk.h"

#include "path/techniques/Connection.h"

#include "transport/Balance.h"

namespace tungsten::path {

namespace {

constexpr float RouletteThreshold = 0.1f;
constexpr int RouletteFirstVertex = 3;

} // namespace

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::run(Ray ray) {
    path_.ray = ray;
    path_.region = scene_.cameraRegion;
    ++path_.counters.paths;
    while (path_.interactions < scene_.transport.maxBounces) {
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
    // The free flight comes first: the ray need not look beyond its collision.
    const FlightSample flight = sampleFlight(medium, Infinity, path_.sampler);
    path_.ray.tMax = flight.distance;
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
            if (arrival_.mayArrive(position, path_.time)) return false;
            return !source_ ||
                   !arrival_.beforeEnd(path_.time, (source_->point.position - position).length(), source_->start);
        }
    return false;
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::continueRoulette() {
    if (!settings_.russianRoulette || path_.interactions < RouletteFirstVertex) return true;
    const float survival = maxComponent(path_.throughput);
    if (survival >= RouletteThreshold) return true;
    if (path_.sampler.next1D() >= survival) return false;
    path_.throughput = path_.throughput / survival;
    return true;
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::scatterInMedium(const Medium& medium, float distance) {
    ++path_.counters.mediumEvents;
    advanceClock(distance);
    ++path_.interactions;
    ++path_.mediumScatters;
    path_.scattered = true;
    vertex_ = path_.ray.at(distance);
    if (tooLate(vertex_) || path_.interactions >= scene_.transport.maxBounces) return false;
    const Vec3f before = path_.ray.direction;
    if (settings_.volumeLightSampling && orderCounts()) connectFromMedium(medium);
    if (settings_.volumeLightSampling && source_) connectMediumToSource(medium);
    path_.ray = Ray{vertex_, medium.phase.sample(before, path_.sampler.next2D())};
    directionPdf_ = medium.phase.pdf(before, path_.ray.direction);
    weighted_ = settings_.volumeLightSampling;
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
    // The format ends such a path at any surface, index-matched ones included.
    if (path_.mediumScatters == 1 && !settings_.lowOrderScattering) return false;

    const SurfaceInteraction surface = makeInteraction(scene_, hit, path_.ray.direction);
    const LobeMask lobes = surface.bsdf->lobes();
    const bool smooth = (lobes & lobe::Smooth) != 0;
    if (smooth && settings_.lightSampling && orderCounts()) connectFromSurface(surface);
    if (smooth && settings_.lightSampling && source_) connectSurfaceToSource(surface);
    const auto exit =
        sampleExit(surface, surface.query(TransportMode::Radiance), scene_.transport.consistencyChecks, path_.sampler);
    if (!exit) return false;
    path_.throughput = path_.throughput * exit->weight;
    if (isBlack(path_.throughput)) return false;
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
    path_.sink.add(path_.throughput * radiance * weight, path_.time + emitter.emissionTime);
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
    path_.sink.add(path_.throughput * environmentRadiance(emitter, path_.ray.direction) * weight, Infinity);
}

template <bool TimeResolved, bool Media>
auto PathWalk<TimeResolved, Media>::sampleLight(const Vec3f& position) -> std::optional<LightSample> {
    const auto choice = lights_.sample(path_.sampler.next1D());
    if (!choice) return std::nullopt;
    const auto direct = sampleDirect(*choice->emitter, position, path_.sampler.next2D());
    if (!direct) return std::nullopt;
    ++path_.counters.connections;
    if constexpr (TimeResolved)
        if (!arrival_.mayConnect(path_.time, direct->distance, choice->emitter->emissionTime)) return std::nullopt;
    return LightSample{*choice->emitter, *direct, choice->probability};
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectFromMedium(const Medium& medium) {
    const auto light = sampleLight(vertex_);
    if (!light) return;
    const float phase = medium.phase.eval(path_.ray.direction, light->direct.direction);
    addConnection(*light, Rgb(phase), phase, {vertex_, light->direct.direction}, path_.region);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectFromSurface(const SurfaceInteraction& surface) {
    const auto light = sampleLight(surface.hit.position);
    if (!light || !surface.consistent(light->direct.direction, scene_.transport.consistencyChecks)) return;
    const Vec3f wo = surface.frame.toLocal(light->direct.direction);
    const Rgb scattering = surface.bsdf->eval(surface.query(TransportMode::Radiance, lobe::Smooth), surface.wi, wo);
    if (isBlack(scattering)) return;
    const float pdf = surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi, wo);
    const Region region = regionBeyond(surface, light->direct.direction, path_.region);
    addConnection(*light, scattering, pdf, surface.hit.leave(light->direct.direction), region);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::addConnection(const LightSample& light, const Rgb& scattering, float directionPdf,
                                                  Ray ray, const Region& region) {
    ray.tMax = light.direct.reach();
    const Visibility visibility =
        traceConnection(scene_, forwardBoundaries_, ray, light.direct.distance, region, path_.counters.shadowRays);
    if (isBlack(visibility.transmittance) || !rendered(path_.interactions + visibility.crossings)) return;
    // Point-like emitters cannot be found by the walk: full weight.
    const float pdf = light.direct.pdf;
    const float weight = pdf > 0.0f ? transport::powerHeuristic(pdf * light.probability, directionPdf) : 1.0f;
    const Rgb radiance =
        path_.throughput * scattering * light.direct.weight * visibility.transmittance * (weight / light.probability);
    path_.sink.add(radiance, path_.time + visibility.time + light.emitter.emissionTime);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectMediumToSource(const Medium& medium) {
    const Vec3f offset = source_->point.position - vertex_;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return;
    const Vec3f direction = offset / distance;
    addSource(Rgb(medium.phase.eval(path_.ray.direction, direction)), {vertex_, direction}, distance, path_.region);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectSurfaceToSource(const SurfaceInteraction& surface) {
    const Vec3f offset = source_->point.position - surface.hit.position;
    const float distance = offset.length();
    const Vec3f direction = offset / distance;
    if (!(distance > 0.0f) || !surface.consistent(direction, scene_.transport.consistencyChecks)) return;
    const Rgb scattering = surface.bsdf->eval(surface.query(TransportMode::Radiance, lobe::Smooth), surface.wi,
                                              surface.frame.toLocal(direction));
    const Region region = regionBeyond(surface, direction, path_.region);
    addSource(scattering, surface.hit.leave(direction), distance, region);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::addSource(const Rgb& scattering, Ray ray, float distance, const Region& region) {
    if (!orderCounts(source_->mediumScatters)) return;
    ++path_.counters.connections;
    if constexpr (TimeResolved)
        if (!arrival_.mayConnect(path_.time, distance, source_->start)) return;
    const Rgb light = scattering * source_->intensity(-ray.direction) / sqr(distance);
    if (isBlack(light)) return;
    ray.tMax = source_->point.margin().before(ray.direction, distance);
    const Visibility visibility =
        traceConnection(scene_, forwardBoundaries_, ray, distance, region, path_.counters.shadowRays);
    if (isBlack(visibility.transmittance)) return;
    if (!rendered(path_.interactions + visibility.crossings + source_->interactions)) return;
    path_.sink.add(path_.throughput * light * visibility.transmittance, path_.time + visibility.time + source_->start);
}

template class PathWalk<false, false>;
template class PathWalk<false, true>;
template class PathWalk<true, false>;
template class PathWalk<true, true>;

} // namespace tungsten::path
