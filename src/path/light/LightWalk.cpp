#include "path/light/LightWalk.h"

#include "transport/DetectorLight.h"
#include "transport/Roulette.h"

namespace tungsten::path {

using transport::Vertex;

void LightWalk::run() {
    if (!emit()) return;
    // The last vertex needs no way on.
    while (context_.limits.mayGoOn(interactions_ + 1)) {
        counters_.step(context_.watch);
        if (const Medium* medium = scene_.medium(region_)) {
            if (!crossMedium(*medium)) return;
            continue;
        }
        ++counters_.rays;
        const auto hit = scene_.geometry->intersect(ray_);
        if (!hit || !scatterOnSurface(*hit)) return;
    }
}

bool LightWalk::emit() {
    const auto chosen = context_.emitters.sample(sampler_.next1D());
    const Emitter& emitter = scene_.emitters[chosen.index];
    time_ = emitter.emissionTime + context_.sensor.delays.sample(emitter, sampler_);
    scattered_ = time_;
    const bool detectors = scene_.camera.detectors() != nullptr;
    if (emitter.primitive() || (detectors && !emitter.isDelta() && !emitter.isInfinite()))
        showEmitter(emitter, chosen.probability);
    if (detectors && emitter.isInfinite()) showEnvironment(emitter, chosen.probability);
    sampler_.at(0, Draw::Emission);
    const Vec2f uPosition = sampler_.next2D();
    const EmissionSample emission = sampleEmission(emitter, uPosition, sampler_.next2D());
    power_ = emission.power / chosen.probability;
    region_ = scene_.regionOf(emitter);
    ray_ = emission.ray;
    if (emitter.isDelta()) meetDetectors();
    return !isBlack(power_);
}

void LightWalk::showEmitter(const Emitter& emitter, float probability) {
    sampler_.at(0, Draw::Light);
    const SurfaceSample point = sampleEmissionPoint(emitter, sampler_.next2D());
    connect({scene_, emitter, point}, Rgb(1.0f / probability));
}

void LightWalk::showEnvironment(const Emitter& emitter, float probability) {
    if (&emitter != &scene_.emitters[size_t(scene_.infiniteEmitters.back())] || !context_.limits.orderCounts(0, 0))
        return;
    const auto& row = scene_.camera.detectors()->row;
    sampler_.at(0, Draw::Distance);
    const auto column = std::min(size_t(sampler_.next1D() * float(row.size())), row.size() - 1);
    const Vec2f uPlace = sampler_.next2D();
    const Ray towards = row[column].sampleRay(uPlace, sampler_.next2D());
    const Rgb radiance = environmentRadiance(emitter, towards.direction) * (float(row.size()) / probability);
    const auto seen = context_.connector.visibility(towards, Infinity, scene_.cameraRegion, counters_.shadowRays);
    if (isBlack(radiance) || isBlack(seen.transmittance)) return;
    arriveAtSensor({float(column), 0.0f}, {radiance * seen.transmittance, seen.time, seen.crossings, seen.oneSpeed},
                   time_);
}

bool LightWalk::crossMedium(const Medium& medium) {
    if (medium.scatters() && ++flights_ > medium.maxBounces) return false;
    sampler_.at(interactions_ + 1, Draw::Flight);
    const FlightSample flight = sampleFlight(medium, Infinity, sampler_);
    ray_.tMax = flight.distance;
    counters_.fly(medium);
    ++counters_.rays;
    const auto hit = scene_.geometry->intersect(ray_);
    if (!hit && flight.exited) return false;
    if (!hit) {
        throughput_ = throughput_ * flight.weight;
        return scatterInMedium(medium, flight.distance);
    }
    throughput_ = throughput_ * (medium.transmittance(hit->t) / probabilityFlightExits(medium, hit->t));
    return scatterOnSurface(*hit);
}

bool LightWalk::arrive(const Vec3f& position, float length) {
    time_ += double(length) / double(region_.speed);
    ++interactions_;
    const Camera& camera = scene_.camera;
    // Orthographic rays start anywhere.
    const bool anywhere = scene_.transport.cameraUnwarped || camera.hasParallelRays();
    const float gap = anywhere ? 0.0f : std::max((position - camera.position()).length() - camera.aperture(), 0.0f);
    return !isBlack(throughput_) && context_.bounds.beforeEnd(time_, double(gap));
}

bool LightWalk::scatterInMedium(const Medium& medium, float distance) {
    counters_.scatter(medium);
    ++mediumScatters_;
    inARow_ = flights_; // those before have scattered here, too
    const Vec3f position = ray_.at(distance), before = ray_.direction;
    if (!arrive(position, distance)) return false;
    scattered_ = time_;
    connect({medium, position, before, region_}, power_ * throughput_);
    sampler_.at(interactions_, Draw::Direction);
    ray_ = Ray{position, medium.phase.sample(before, sampler_.next2D())};
    return continueRoulette();
}

bool LightWalk::scatterOnSurface(const SurfaceHit& hit) {
    ++counters_.surfaceEvents;
    flights_ = 0;
    if (!arrive(hit.position, hit.t)) return false;
    const SurfaceInteraction surface = makeInteraction(scene_, hit, ray_.direction);
    connect({scene_, surface, ray_.direction, TransportMode::Photons, region_}, power_ * throughput_);
    sampler_.at(interactions_, Draw::Direction);
    const auto exit =
        sampleExit(surface, surface.query(TransportMode::Photons), scene_.transport.consistencyChecks, sampler_);
    if (!exit) return false;
    const float shading = exit->straight() ? 1.0f : surface.photonShadingFactor(-ray_.direction, exit->direction);
    throughput_ = throughput_ * (exit->weight * shading);
    counters_.leave(exit->lobe);
    region_ = regionBeyond(surface, exit->direction, region_);
    ray_ = hit.leave(exit->direction);
    if ((exit->lobe & lobe::Smooth) != 0) scattered_ = time_;
    if ((exit->lobe & lobe::Specular) != 0) meetDetectors();
    return !isBlack(throughput_) && continueRoulette();
}

bool LightWalk::continueRoulette() {
    if (!context_.russianRoulette) return true;
    sampler_.at(interactions_, Draw::Roulette);
    return transport::survivesRoulette(throughput_, interactions_, sampler_);
}

void LightWalk::connect(const Vertex& vertex, const Rgb& power) {
    if (!vertex.isConnectible() || !context_.limits.orderCounts(mediumScatters_, inARow_)) return;
    sampler_.at(interactions_, Draw::Sensor);
    const auto sensor = scene_.camera.sampleSensor(vertex.position(), sampler_.next2D());
    if (!sensor || !inView(sensor->raster)) return;
    const bool unwarped = scene_.transport.cameraUnwarped;
    if (!context_.bounds.mayArrive(time_, unwarped ? 0.0 : double(sensor->distance))) return;
    ++counters_.connections;
    const auto connection =
        context_.connector.connect(vertex, power, transport::connectionEnd(*sensor), counters_.shadowRays);
    if (connection) arriveAtSensor(sensor->raster, *connection, time_);
}

void LightWalk::meetDetectors() {
    const Detectors* detectors = scene_.camera.detectors();
    if (!detectors || !context_.limits.orderCounts(mediumScatters_, inARow_)) return;
    for (size_t column = 0; column < detectors->row.size(); ++column) {
        const auto met = transport::meetDetector(context_.connector, detectors->row[column], ray_, region_,
                                                 power_ * throughput_, counters_.shadowRays);
        if (met) arriveAtSensor({float(column), 0.0f}, *met, scattered_);
    }
}

void LightWalk::arriveAtSensor(const Vec2f& raster, const transport::Connection& connection, double scattered) {
    if (!context_.limits.renders(interactions_ + connection.crossings)) return;
    const double time = scene_.transport.cameraUnwarped ? scattered : time_ + connection.time;
    const int frame = context_.sensor.frameOf(time);
    if (frame < 0) return;
    const Rgb radiance = connection.throughput * float(context_.sensor.density(time));
    if (!isFinite(radiance)) {
        ++counters_.nonFinite;
        return;
    }
    if (!context_.sensor.gate.steadyState) ++counters_.timed;
    if (context_.sensor.response) ++counters_.weighed;
    if (frame > 0) ++counters_.laterFrames;
    splats_.push_back({raster, frame, radiance});
}

bool LightWalk::inView(const Vec2f& raster) const {
    const Vec2i& size = scene_.camera.resolution;
    const float reach = scene_.camera.filter.reach();
    return raster.x >= -reach && raster.y >= -reach && raster.x <= float(size.x - 1) + reach &&
           raster.y <= float(size.y - 1) + reach;
}

} // namespace tungsten::path
