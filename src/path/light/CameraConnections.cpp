#include "path/light/CameraConnections.h"

#include "transport/Balance.h"
#include "transport/DetectorLight.h"

namespace tungsten::path {

using transport::Ahead;
using transport::Flight;
using transport::Vertex;
using transport::WalkVertex;
using transport::Way;

namespace {

/// What light at a place in a medium is worth to detectors, over what it was worth where its path started: the mean
/// over detectors of what diffusion brings to each, which gets paths of about the same weight whatever its distance.
/// With mu = sqrt(3 sigma_a (sigma_a + sigma_s (1 - g))) that is exp(-mu r) / r in a medium, and (1 + mu r) exp(-mu r)
/// / r^3, the flux of a dipole, out of one that ends (Farrell et al. 1992). Whatever the function, the image is the
/// same.
class DetectorImportance {
  public:
    /// `start`: of the path. `inside`: the detectors are in what scatters.
    DetectorImportance(const Detectors& detectors, bool inside, const Vec3f& start)
        : detectors_(&detectors), inside_(inside), start_(start) {}

    [[nodiscard]] float at(const Vec3f& position, const Medium& medium) const {
        const float scatters = meanComponent(medium.sigmaS()) * (1.0f - medium.phase.g()),
                    absorbs = meanComponent(medium.sigmaA()), mu = std::sqrt(3.0f * absorbs * (absorbs + scatters));
        // Nearer than light keeps its direction, or than the disc is wide, places differ little.
        const float mean = 1.0f / std::max(absorbs + scatters, 1e-20f);
        float sum = 0.0f;
        for (const Detector& detector : detectors_->row) {
            const float least = std::max(mean, detector.radius);
            const float here = std::max((position - detector.position).length(), least),
                        before = std::max((start_ - detector.position).length(), least), nearer = before / here;
            const float slope = inside_ ? 1.0f : sqr(nearer) * (1.0f + mu * here) / (1.0f + mu * before);
            sum += std::min(nearer * slope * std::exp(std::min(mu * (before - here), 80.0f)), Most);
        }
        return sum / float(detectors_->row.size());
    }

  private:
    /// Copies of a path: a bound on its time, where the function is a bad guess.
    static constexpr float Most = 1e4f;

    const Detectors* detectors_;
    bool inside_;
    Vec3f start_;
};

/// Steps of a plain light path that is split on its way to detectors, and ended where it goes away from them.
class StepsToDetectors : public transport::PlainLightSteps {
  public:
    explicit StepsToDetectors(const transport::WalkContext& context) : PlainSteps(context) {}
    /// Prepares the steps of the path, once it is known where it starts.
    void startAt(const Vec3f& position) {
        const Scene& scene = context().scene;
        const Medium* medium = scene.medium(scene.cameraRegion);
        importance_.emplace(*scene.camera.detectors(), medium && medium->scatters(), position);
    }

    int copies(transport::PathState& path, const transport::WalkVertex& vertex) {
        if (!vertex.medium) return 1;
        const float worth = meanComponent(path.throughput) * importance_->at(vertex.position, *vertex.medium);
        return splitting_.copies(path, worth, worth, Draw::Connection, std::numeric_limits<int>::max());
    }

  private:
    std::optional<DetectorImportance> importance_;
    transport::Splitting splitting_;
};

} // namespace

bool CameraConnections::emit(PathState& path) {
    const auto chosen = context_->emitters.sample(path.random.next1D());
    const Emitter& emitter = scene().emitters[chosen.index];
    path.time = emitter.emissionTime + context_->sensor.delays.sample(emitter, path.random);
    scattered_ = path.time;
    const bool detectors = scene().camera.detectors() != nullptr;
    if (emitter.primitive() || (detectors && !emitter.isDelta() && !emitter.isInfinite()))
        showEmitter(path, emitter, chosen.probability);
    if (detectors && emitter.isInfinite()) showEnvironment(path, emitter, chosen.probability);
    path.random.at(0, Draw::Emission);
    const Vec2f uPosition = path.random.next2D();
    const EmissionSample emission = sampleEmission(emitter, uPosition, path.random.next2D());
    power_ = emission.power / chosen.probability;
    path.region = scene().regionOf(emitter);
    path.ray = emission.ray;
    if (emitter.isDelta()) meetDetectors(path, path.ray, path.region, power_, 0.0f);
    return !isBlack(power_);
}

void CameraConnections::showEmitter(PathState& path, const Emitter& emitter, float probability) {
    path.random.at(0, Draw::Light);
    const SurfaceSample point = sampleEmissionPoint(emitter, path.random.next2D());
    connect(path, {scene(), emitter, point}, Rgb(1.0f / probability), false);
}

void CameraConnections::showEnvironment(PathState& path, const Emitter& emitter, float probability) {
    if (&emitter != &scene().emitters[size_t(scene().infiniteEmitters.back())] || !context_->limits.orderCounts(0, 0))
        return;
    const auto& row = scene().camera.detectors()->row;
    path.random.at(0, Draw::Distance);
    const auto column = std::min(size_t(path.random.next1D() * float(row.size())), row.size() - 1);
    const Vec2f uPlace = path.random.next2D();
    const Ray towards = row[column].sampleRay(uPlace, path.random.next2D());
    const Rgb radiance = environmentRadiance(emitter, towards.direction) * (float(row.size()) / probability);
    const auto seen = context_->connector.visibility(towards, Infinity, scene().cameraRegion, counters_->shadowRays);
    if (isBlack(radiance) || isBlack(seen.transmittance)) return;
    arriveAtSensor(path, {float(column), 0.0f},
                   {radiance * seen.transmittance, seen.time, seen.crossings, seen.oneSpeed}, path.time);
}

bool CameraConnections::arrive(PathState& path, auto&, const Ahead&, const Flight& flight) {
    if (flight.event == Flight::Event::Collision) inARow_ = path.inARow;
    const Camera& camera = scene().camera;
    // Orthographic rays start anywhere.
    const bool anywhere = scene().transport.cameraUnwarped || camera.hasParallelRays();
    const float gap =
        anywhere ? 0.0f : std::max((path.ray.origin - camera.position()).length() - camera.aperture(), 0.0f);
    return context_->bounds.beforeEnd(path.time, double(gap));
}

bool CameraConnections::vertex(PathState& path, auto&, const WalkVertex& at) {
    if (at.medium) scattered_ = path.time;
    connect(path, at.connectible(scene(), TransportMode::Photons), power_ * path.throughput, true);
    return true;
}

void CameraConnections::leave(PathState& path, auto&, const WalkVertex& at, const Way& way) {
    if (at.surface && way.smooth()) scattered_ = path.time;
    // What passes straight has been looked for from before.
    if (!way.straight()) meetDetectors(path, way.ray, way.region, power_ * (path.throughput * way.weight), way.pdf);
}

void CameraConnections::connect(PathState& path, const Vertex& vertex, const Rgb& power, bool mayMeet) {
    if (!vertex.isConnectible() || !orderCounts(path)) return;
    path.random.at(path.interactions, Draw::Sensor);
    const auto sensor = scene().camera.sampleSensor(vertex.position(), path.random.next2D());
    if (!sensor || !inView(sensor->raster)) return;
    const bool unwarped = scene().transport.cameraUnwarped;
    if (!context_->bounds.mayArrive(path.time, unwarped ? 0.0 : double(sensor->distance))) return;
    ++counters_->connections;
    float share = 1.0f;
    if (const Detectors* detectors = scene().camera.detectors(); detectors && mayMeet)
        share = transport::balance(detectors->pdf(size_t(sensor->raster.x), sensor->direction, sensor->distance),
                                   vertex.pdf(sensor->direction));
    const auto connection = context_->connector.connect(vertex, power * share, transport::connectionEndpoint(*sensor),
                                                        counters_->shadowRays);
    if (connection) arriveAtSensor(path, sensor->raster, *connection, path.time);
}

void CameraConnections::meetDetectors(const PathState& path, const Ray& ray, const Region& region, const Rgb& power,
                                      float pdf) {
    const Detectors* detectors = scene().camera.detectors();
    if (!detectors || !orderCounts(path)) return;
    for (size_t column = 0; column < detectors->row.size(); ++column) {
        const auto distance = detectors->row[column].intersect(ray);
        if (!distance) continue;
        const float share =
            pdf > 0.0f ? transport::balance(pdf, detectors->pdf(column, ray.direction, *distance)) : 1.0f;
        const auto met = transport::meetDetector(context_->connector, detectors->row[column], ray, region,
                                                 power * share, counters_->shadowRays);
        if (met) arriveAtSensor(path, {float(column), 0.0f}, *met, scattered_);
    }
}

void CameraConnections::arriveAtSensor(const PathState& path, const Vec2f& raster,
                                       const transport::Connection& connection, double scattered) {
    if (!context_->limits.renders(path.interactions + connection.crossings)) return;
    const double time = scene().transport.cameraUnwarped ? scattered : path.time + connection.time;
    const int frame = context_->sensor.frameOf(time);
    if (frame < 0) return;
    const Rgb radiance = connection.throughput * float(context_->sensor.density(time));
    if (!isFinite(radiance)) {
        ++counters_->nonFinite;
        return;
    }
    if (!context_->sensor.gate.steadyState) ++counters_->timed;
    if (context_->sensor.response) ++counters_->weighed;
    if (frame > 0) ++counters_->laterFrames;
    splats_->push_back({raster, frame, radiance});
}

bool CameraConnections::inView(const Vec2f& raster) const {
    const Vec2i& size = scene().camera.resolution;
    const float reach = scene().camera.filter.reach();
    return raster.x >= -reach && raster.y >= -reach && raster.x <= float(size.x - 1) + reach &&
           raster.y <= float(size.y - 1) + reach;
}

void traceLightPath(const LightContext& context, const Sampler& sampler, std::vector<Splat>& splats,
                    LightCounters& counters) {
    const auto trace = [&](auto steps) {
        transport::Walk walk{PathState{.random = sampler}, std::move(steps),
                             CameraConnections(context, splats, counters)};
        walk.steps.roulette = context.russianRoulette;
        if (!walk.visitor.emit(walk.path)) return;
        if constexpr (std::is_same_v<decltype(steps), StepsToDetectors>) walk.steps.startAt(walk.path.ray.origin);
        walk.run();
    };
    const transport::WalkContext all{context.scene, counters, context.watch};
    if (context.splits)
        trace(StepsToDetectors(all));
    else
        trace(transport::PlainLightSteps(all));
}

} // namespace tungsten::path
