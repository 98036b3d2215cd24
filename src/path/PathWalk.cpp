#include "path/PathWalk.h"

namespace tungsten::path {

namespace {

/// Power heuristic with exponent 2 (Veach 1997).
float powerHeuristic(float a, float b) {
    const float aa = a * a, bb = b * b;
    return aa + bb > 0.0f ? aa / (aa + bb) : 0.0f;
}

constexpr float RouletteThreshold = 0.1f;
constexpr int RouletteFirstVertex = 3;

} // namespace

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::run(Ray ray) {
    ray_ = ray;
    region_ = scene_.cameraRegion;
    ++counters_.paths;
    while (interactions_ < scene_.transport.maxBounces) {
        ++counters_.rays;
        const auto hit = scene_.geometry->intersect(ray_);
        if constexpr (Media) {
            if (const Medium* medium = scene_.medium(region_)) {
                const float reach = hit ? hit->t : Infinity;
                const FlightSample flight = sampleFlight(*medium, reach, sampler_);
                throughput_ = throughput_ * flight.weight;
                if (medium->scatters() && ++flights_ > medium->maxBounces) return;
                if (!flight.exited) {
                    if (!scatterInMedium(*medium, flight.distance)) return;
                    continue;
                }
            }
        }
        if (!hit) return addEnvironment();
        if (isBlack(throughput_) || !scatterOnSurface(*hit)) return;
    }
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::advanceClock(float length) {
    if constexpr (TimeResolved)
        if (scattered_ || !scene_.transport.cameraUnwarped) time_ += double(length) / double(region_.speed);
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::tooLate() const {
    if constexpr (TimeResolved) return time_ + lights_.earliestEmission() >= scene_.transport.gate.end();
    return false;
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::continueRoulette() {
    if (!settings_.russianRoulette || interactions_ < RouletteFirstVertex) return true;
    const float survival = maxComponent(throughput_);
    if (survival >= RouletteThreshold) return true;
    if (sampler_.next1D() >= survival) return false;
    throughput_ = throughput_ / survival;
    return true;
}

template <bool TimeResolved, bool Media>
bool PathWalk<TimeResolved, Media>::scatterInMedium(const Medium& medium, float distance) {
    ++counters_.mediumEvents;
    advanceClock(distance);
    ++interactions_;
    ++mediumScatters_;
    scattered_ = true;
    if (tooLate() || interactions_ >= scene_.transport.maxBounces) return false;
    const Vec3f before = ray_.direction;
    vertex_ = ray_.at(distance);
    if (settings_.volumeLightSampling && orderCounts()) connectFromMedium(medium);
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
    if (tooLate()) return false;
    if (hit.shape < scene_.primitives.size() && scene_.primitives[hit.shape].emitter >= 0) addEmission(hit);
    if (++interactions_ >= scene_.transport.maxBounces) return false;

    const SurfaceInteraction surface = makeInteraction(scene_, hit, ray_.direction);
    const LobeMask lobes = surface.bsdf->lobes();
    const bool smooth = (lobes & lobe::Smooth) != 0;
    if (smooth && mediumScatters_ == 1 && !settings_.lowOrderScattering) return false;
    if (smooth && settings_.lightSampling && orderCounts()) connectFromSurface(surface);
    const BsdfRandom random{sampler_.next2D(), sampler_.next1D()};
    const auto sample = surface.bsdf->sample(surface.query(TransportMode::Radiance), surface.wi, random);
    if (!sample) return false;
    const Vec3f direction = surface.frame.toWorld(sample->wo).normalized();
    const bool straight = sample->lobe == lobe::Forward;
    if (!straight && !surface.consistent(direction, scene_.transport.consistencyChecks)) return false;
    throughput_ = throughput_ * sample->weight;
    if (isBlack(throughput_)) return false;
    if ((sample->lobe & lobe::Smooth) != 0) {
        scattered_ = true;
        weighted_ = settings_.lightSampling;
        directionPdf_ = sample->pdf;
        vertex_ = hit.position;
    } else if (!straight) {
        weighted_ = false; // emitters seen in a mirror cannot be connected to
    }
    region_ = regionBeyond(*surface.primitive, hit, direction, region_);
    ray_ = Ray{hit.position, direction, scene_.rayEpsilon};
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
void PathWalk<TimeResolved, Media>::connectFromMedium(const Medium& medium) {
    const auto choice = lights_.sample(sampler_.next1D());
    if (!choice) return;
    const auto light = sampleDirect(*choice->emitter, vertex_, sampler_.next2D());
    if (!light) return;
    const float phase = medium.phase.eval(ray_.direction, light->direction);
    addConnection(*choice->emitter, *light, choice->probability, Rgb(phase), phase, vertex_, false, region_);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::connectFromSurface(const SurfaceInteraction& surface) {
    const auto choice = lights_.sample(sampler_.next1D());
    if (!choice) return;
    const auto light = sampleDirect(*choice->emitter, surface.hit.position, sampler_.next2D());
    if (!light || !surface.consistent(light->direction, scene_.transport.consistencyChecks)) return;
    const BsdfQuery query = surface.query(TransportMode::Radiance, lobe::Smooth);
    const Vec3f wo = surface.frame.toLocal(light->direction);
    const Rgb scattering = surface.bsdf->eval(query, surface.wi, wo);
    if (isBlack(scattering)) return;
    const float pdf = surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi, wo);
    const Region region = regionBeyond(*surface.primitive, surface.hit, light->direction, region_);
    addConnection(*choice->emitter, *light, choice->probability, scattering, pdf, surface.hit.position, true, region);
}

template <bool TimeResolved, bool Media>
void PathWalk<TimeResolved, Media>::addConnection(const Emitter& emitter, const DirectSample& light,
                                                  float lightProbability, const Rgb& scattering, float directionPdf,
                                                  const Vec3f& origin, bool fromSurface, const Region& region) {
    const Visibility visibility = traceVisibility(scene_, origin, fromSurface, light.direction, light.distance,
                                                  emitter.isArea(), region, counters_.shadowRays);
    if (isBlack(visibility.transmittance) || !rendered(interactions_ + visibility.crossings)) return;
    // Point-like emitters cannot be found by the walk: full weight.
    const float weight = light.pdf > 0.0f ? powerHeuristic(light.pdf * lightProbability, directionPdf) : 1.0f;
    const Rgb radiance =
        throughput_ * scattering * light.weight * visibility.transmittance * (weight / lightProbability);
    sink_.add(radiance, time_ + visibility.time + emitter.emissionTime);
}

template class PathWalk<false, false>;
template class PathWalk<false, true>;
template class PathWalk<true, false>;
template class PathWalk<true, true>;

} // namespace tungsten::path
