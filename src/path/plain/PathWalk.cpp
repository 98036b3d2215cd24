#include "path/plain/PathWalk.h"

#include "transport/Roulette.h"

namespace tungsten::path {

using transport::Vertex;

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::run(Ray ray) {
    ray_ = ray;
    region_ = scene_.cameraRegion;
    ++counters_.paths;
    while (interactions_ < scene_.transport.maxBounces) {
        if constexpr (Media) {
            if (const Medium* medium = scene_.medium(region_)) {
                if (!crossMedium(*medium)) return;
                continue;
            }
        }
        ++counters_.rays;
        if (!arriveAt(scene_.geometry->intersect(ray_))) return;
    }
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::crossMedium(const Medium& medium) {
    if (medium.scatters() && ++flights_ > medium.maxBounces) return false;
    // The free flight comes first: the ray need not look beyond its collision.
    const FlightSample flight = sampleFlight(medium, Infinity, sampler_);
    ray_.tMax = flight.distance;
    ++counters_.rays;
    const auto hit = scene_.geometry->intersect(ray_);
    if (!hit && !flight.exited) {
        throughput_ = throughput_ * flight.weight;
        return scatterInMedium(medium, flight.distance);
    }
    const float reach = hit ? hit->t : Infinity;
    throughput_ = throughput_ * (medium.transmittance(reach) / probabilityFlightExits(medium, reach));
    return arriveAt(hit);
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::arriveAt(const std::optional<SurfaceHit>& hit) {
    if (hit) return !isBlack(throughput_) && scatterOnSurface(*hit);
    addEnvironment();
    return false;
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::advanceClock(float length) {
    if constexpr (TimeResolved)
        if (timed()) time_ += double(length) / double(region_.speed);
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::tooLate(const Vec3f& position) const {
    // Unwarped time starts where the camera's own specular chain ends, wherever that will be.
    if constexpr (TimeResolved)
        if (timed()) {
            if (arrival_.mayArrive(position, time_)) return false;
            return !source_ ||
                   !arrival_.beforeEnd(time_, (source_->point.position - position).length(), source_->start);
        }
    return false;
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::continueRoulette() {
    return !settings_.russianRoulette || transport::survivesRoulette(throughput_, interactions_, sampler_);
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::scatterInMedium(const Medium& medium, float distance) {
    ++counters_.mediumEvents;
    advanceClock(distance);
    ++interactions_;
    ++mediumScatters_;
    scattered_ = true;
    vertex_ = ray_.at(distance);
    if (tooLate(vertex_) || interactions_ >= scene_.transport.maxBounces) return false;
    const Vec3f before = ray_.direction;
    if (settings_.volumeLightSampling) connect({medium, vertex_, before, region_});
    ray_ = Ray{vertex_, medium.phase.sample(before, sampler_.next2D())};
    directionPdf_ = medium.phase.pdf(before, ray_.direction);
    weighted_ = settings_.volumeLightSampling;
    return continueRoulette();
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::scatterOnSurface(const SurfaceHit& hit) {
    ++counters_.surfaceEvents;
    advanceClock(hit.t);
    flights_ = 0;
    if (tooLate(hit.position)) return false;
    if (hit.shape < scene_.primitives.size() && scene_.primitives[hit.shape].emitter >= 0) addEmission(hit);
    if (++interactions_ >= scene_.transport.maxBounces) return false;
    if (settings_.limits.endsAtSurface(mediumScatters_)) return false;

    const SurfaceInteraction surface = makeInteraction(scene_, hit, ray_.direction);
    const LobeMask lobes = surface.bsdf->lobes();
    if (settings_.lightSampling && (lobes & lobe::Smooth) != 0)
        connect({scene_, surface, TransportMode::Radiance, region_});
    const auto exit =
        sampleExit(surface, surface.query(TransportMode::Radiance), scene_.transport.consistencyChecks, sampler_);
    if (!exit) return false;
    throughput_ = throughput_ * exit->weight;
    if (isBlack(throughput_)) return false;
    if ((exit->lobe & lobe::Smooth) != 0) {
        scattered_ = true;
        weighted_ = settings_.lightSampling;
        directionPdf_ = exit->pdf;
        vertex_ = hit.position;
    } else if (!exit->straight()) {
        weighted_ = false; // emitters seen in a mirror cannot be connected to
    }
    region_ = regionBeyond(surface, exit->direction, region_);
    ray_ = hit.leave(exit->direction);
    return continueRoulette();
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::addEmission(const SurfaceHit& hit) {
    const int index = scene_.primitives[hit.shape].emitter;
    const Emitter& emitter = scene_.emitters[size_t(index)];
    const Rgb radiance = emittedRadiance(emitter, hit.uv, hit.ng, -ray_.direction);
    if (isBlack(radiance) || !rendered(interactions_) || !orderCounts()) return;
    float weight = 1.0f;
    if (weighted_) {
        const float lightPdf = pdfDirect(emitter, vertex_, hit.position, hit.ng) * lights_.probability(index);
        weight = powerHeuristic(directionPdf_, lightPdf);
    }
    sink_.add(throughput_ * radiance * weight, time_ + emitter.emissionTime);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::addEnvironment() {
    if (scene_.infiniteEmitters.empty() || scene_.medium(region_) || !rendered(interactions_) || !orderCounts()) return;
    const int index = scene_.infiniteEmitters.back();
    const Emitter& emitter = scene_.emitters[size_t(index)];
    float weight = 1.0f;
    if (weighted_)
        weight = powerHeuristic(directionPdf_, pdfDirectInfinite(emitter, ray_.direction) * lights_.probability(index));
    sink_.add(throughput_ * environmentRadiance(emitter, ray_.direction) * weight, Infinity);
}

template <bool TimeResolved, bool Media>
auto PathWalk<TimeResolved, Media>::sampleLight(const Vec3f& position) -> std::optional<LightSample> {
    const auto choice = lights_.sample(sampler_.next1D());
    if (!choice) return std::nullopt;
    const auto direct = sampleDirect(*choice->emitter, position, sampler_.next2D());
    if (!direct) return std::nullopt;
    ++counters_.connections;
    if constexpr (TimeResolved)
        if (!arrival_.mayConnect(time_, direct->distance, choice->emitter->emissionTime)) return std::nullopt;
    return LightSample{*choice->emitter, *direct, choice->probability};
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectToLight(const Vertex& vertex) {
    const auto light = sampleLight(vertex.position());
    if (!light) return;
    const auto connection =
        connector_.connect(vertex, throughput_, transport::connectionEnd(light->direct), counters_.shadowRays);
    if (!connection || !rendered(interactions_ + connection->crossings)) return;
    // Point-like emitters cannot be found by the walk: full weight.
    const float pdf = light->direct.pdf;
    const float weight =
        pdf > 0.0f ? powerHeuristic(pdf * light->probability, vertex.pdf(light->direct.direction)) : 1.0f;
    sink_.add(connection->throughput * (weight / light->probability),
              time_ + connection->time + light->emitter.emissionTime);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectToSource(const Vertex& vertex) {
    if (!orderCounts(source_->mediumScatters)) return;
    const auto end = source_->seenFrom(vertex.position());
    if (!end) return;
    ++counters_.connections;
    if constexpr (TimeResolved)
        if (!arrival_.mayConnect(time_, end->distance, source_->start)) return;
    const auto connection = connector_.connect(vertex, throughput_, *end, counters_.shadowRays);
    if (!connection || !rendered(interactions_ + connection->crossings + source_->interactions)) return;
    sink_.add(connection->throughput, time_ + connection->time + source_->start);
}

template class PathWalk<false, false>;
template class PathWalk<false, true>;
template class PathWalk<true, false>;
template class PathWalk<true, true>;

} // namespace tungsten::path
