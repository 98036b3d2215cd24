#include "transport/DetectorLight.h"

#include "transport/PlainSteps.h"

#include "tungsten/scene/LightChoice.h"

namespace tungsten::transport {

namespace {

Distribution1D pointLikeEmitters(const Scene& scene, const SceneFacts& facts) {
    return emitterDistribution(
        scene, [](const Emitter& emitter) { return emitter.isPointLike(); }, facts.excludedEmitters);
}

/// Follows light along specular and forward lobes, and tells where each begins that something has changed.
template <typename Meet>
struct SpecularWay : VisitorBase {
    SpecularWay(const Meet& meetDetectors, const BounceLimits& limitsOfPaths)
        : meet(meetDetectors), limits(&limitsOfPaths) {}

    [[nodiscard]] bool mayGoOn(const PathState& path) const { return limits->mayGoOn(path.interactions + 1); }
    bool vertex(PathState&, auto& steps, const WalkVertex& at) {
        steps.lobes = at.surface->bsdf->lobes() & (lobe::Specular | lobe::Forward);
        return steps.lobes != 0;
    }
    void leave(PathState& path, auto&, const WalkVertex&, const Way& way) {
        if (way.straight()) return; // what passes straight has been looked for from before
        PathState onward = path;
        onward.ray = way.ray;
        onward.region = way.region;
        onward.throughput = path.throughput * way.weight;
        meet(onward);
    }

    Meet meet;
    const BounceLimits* limits;
};

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

bool DetectorLight::mayReach(const Scene& scene, const SceneFacts& facts) {
    return scene.camera.detectors() && pointLikeEmitters(scene, facts).total() > 0.0;
}

DetectorLight::DetectorLight(const Scene& scene, const SceneFacts& facts, const BounceLimits& limits)
    : scene_(scene), limits_(limits), connector_(scene, facts.forwardBoundaries || facts.everything),
      emitters_(pointLikeEmitters(scene, facts)), specular_(facts.specularCameraSubpaths) {}

void DetectorLight::sample(size_t column, Sampler& sampler, const ProgressToken& watch, uint64_t& rays,
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
    const PathState light{.random = sampler,
                          .ray = emission.ray,
                          .region = scene_.regionOf(emitter),
                          .throughput = emission.power / chosen.probability,
                          .time = emitter.emissionTime};
    if (emitter.isDelta()) meet(column, light, emitter, rays, put);
    if (!specular_ || isBlack(light.throughput)) return;
    StepCounters counters;
    Walk walk{light, StraightSteps<TransportMode::Photons>({scene_, counters, watch}),
              SpecularWay([&](const PathState& path) { meet(column, path, emitter, rays, put); }, limits_)};
    walk.run();
    rays += counters.rays;
}

void DetectorLight::connect(size_t column, const SubpathEnd& end, const Emitter& emitter, double time, int interactions,
                            Sampler& sampler, uint64_t& rays, const Put& put) const {
    sampler.at(interactions, Draw::Sensor);
    const auto place = scene_.camera.detectors()->sample(column, end.vertex.position(), sampler.next2D());
    if (!place) return;
    const auto connection = connector_.connect(end.vertex, end.power, connectionEndpoint(*place), rays);
    if (!connection || !limits_.renders(interactions + connection->crossings)) return;
    put(connection->throughput, scene_.transport.cameraUnwarped ? time : time + connection->time, emitter);
}

void DetectorLight::meet(size_t column, const PathState& light, const Emitter& emitter, uint64_t& rays,
                         const Put& put) const {
    const Detector& detector = scene_.camera.detectors()->row[column];
    const auto met = meetDetector(connector_, detector, light.ray, light.region, light.throughput, rays);
    if (!met || !limits_.renders(light.interactions + met->crossings)) return;
    // Specular surfaces do not end the camera's own segments.
    const bool unwarped = scene_.transport.cameraUnwarped;
    put(met->throughput, unwarped ? emitter.emissionTime : light.time + met->time, emitter);
}

} // namespace tungsten::transport
