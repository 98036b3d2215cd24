#include "transport/DetectorLight.h"

#include "tungsten/scene/LightChoice.h"

namespace tungsten::transport {

namespace {

Distribution1D pointLikeEmitters(const Scene& scene, const EffectPlan& facts) {
    return emitterDistribution(
        scene, [](const Emitter& emitter) { return emitter.isPointLike(); }, facts.late);
}

} // namespace

std::optional<Connection> meetDetector(const Connector& connector, const Detector& detector, const Ray& ray,
                                       const Region& region, const Rgb& power, uint64_t& rays) {
    const auto distance = detector.intersect(ray);
    if (!distance || isBlack(power)) return std::nullopt;
    Ray way = ray;
    way.tMax = *distance;
    const Visibility seen = connector.visibility(way, *distance, region, rays);
    if (isBlack(seen.transmittance)) return std::nullopt;
    return Connection{power * seen.transmittance / float(detector.etendue()), seen.time, seen.crossings, seen.oneSpeed};
}

bool DetectorLight::mayReach(const Scene& scene, const EffectPlan& facts) {
    return scene.camera.detectors() && pointLikeEmitters(scene, facts).total() > 0.0;
}

DetectorLight::DetectorLight(const Scene& scene, const EffectPlan& facts, const BounceLimits& limits)
    : scene_(scene), limits_(limits), connector_(scene, facts.forwardBoundaries || facts.everything),
      emitters_(pointLikeEmitters(scene, facts)), specular_(facts.specularSensorPaths) {}

void DetectorLight::sample(size_t column, Sampler& sampler, const PassWatch& watch, uint64_t& rays,
                           const Put& put) const {
    if (!limits_.orderCounts(0)) return;
    const auto chosen = emitters_.sample(sampler.next1D());
    const Emitter& emitter = scene_.emitters[chosen.index];
    const Vec2f uPosition = sampler.next2D();
    if (!emitter.isDelta()) {
        const Vertex point(scene_, emitter, sampleEmissionPoint(emitter, uPosition));
        connect(column, {point, Rgb(1.0f / chosen.probability)}, emitter, emitter.emissionTime, 0, sampler, rays, put);
    }
    if (!emitter.isDelta() && !specular_) return;
    sampler.at(0, Draw::Emission);
    const EmissionSample emission = sampleEmission(emitter, uPosition, sampler.next2D());
    Ballistic light{emission.ray, scene_.regionOf(emitter), emission.power / chosen.probability, emitter.emissionTime};
    if (emitter.isDelta()) meet(column, light, emitter, rays, put);
    StepCounters counters;
    while (specular_ && limits_.mayGoOn(light.interactions + 1) && !isBlack(light.power)) {
        counters.step(watch);
        const auto lobe = goOn(light, sampler, rays);
        if (!lobe) return;
        // What passes straight has been looked for from before.
        if ((*lobe & lobe::Forward) == 0) meet(column, light, emitter, rays, put);
    }
}

void DetectorLight::connect(size_t column, const PathEnd& end, const Emitter& emitter, double time, int interactions,
                            Sampler& sampler, uint64_t& rays, const Put& put) const {
    sampler.at(interactions, Draw::Sensor);
    const auto place = scene_.camera.detectors()->sample(column, end.vertex.position(), sampler.next2D());
    if (!place) return;
    const auto connection = connector_.connect(end.vertex, end.power, connectionEnd(*place), rays);
    if (!connection || !limits_.renders(interactions + connection->crossings)) return;
    put(connection->throughput, scene_.transport.cameraUnwarped ? time : time + connection->time, emitter);
}

void DetectorLight::meet(size_t column, const Ballistic& light, const Emitter& emitter, uint64_t& rays,
                         const Put& put) const {
    const Detector& detector = scene_.camera.detectors()->row[column];
    const auto met = meetDetector(connector_, detector, light.ray, light.region, light.power, rays);
    if (!met || !limits_.renders(light.interactions + met->crossings)) return;
    // Specular surfaces do not end the camera's own segments.
    const bool unwarped = scene_.transport.cameraUnwarped;
    put(met->throughput, unwarped ? emitter.emissionTime : light.time + met->time, emitter);
}

std::optional<LobeMask> DetectorLight::goOn(Ballistic& light, Sampler& sampler, uint64_t& rays) const {
    ++rays;
    const auto hit = scene_.geometry->intersect(light.ray);
    if (!hit) return std::nullopt;
    if (const Medium* medium = scene_.medium(light.region)) light.power = light.power * medium->transmittance(hit->t);
    light.time += double(hit->t) / double(light.region.speed);
    ++light.interactions;
    const Vec3f before = light.ray.direction;
    const SurfaceInteraction surface = makeInteraction(scene_, *hit, before);
    const LobeMask onward = surface.bsdf->lobes() & (lobe::Specular | lobe::Forward);
    if (onward == 0) return std::nullopt;
    sampler.at(light.interactions, Draw::Direction);
    const auto exit =
        sampleExit(surface, surface.query(TransportMode::Photons, onward), scene_.transport.consistencyChecks, sampler);
    if (!exit) return std::nullopt;
    const float shading = exit->straight() ? 1.0f : surface.photonShadingFactor(-before, exit->direction);
    light.power = light.power * (exit->weight * shading);
    light.region = regionBeyond(surface, exit->direction, light.region);
    light.ray = hit->leave(exit->direction);
    return exit->lobe;
}

} // namespace tungsten::transport
