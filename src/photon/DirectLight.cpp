#include "photon/DirectLight.h"

#include "photon/SurfaceConnections.h"

#include <tbb/parallel_for.h>

#include <atomic>

namespace tungsten::photon {

std::optional<ArrivedLight> DirectLight::connect(const Sensor& sensor, float nearField, const SensorState& state,
                                                 const SurfaceInteraction& surface, Sampler& sampler,
                                                 uint64_t& rays) const {
    if (!receivesConnections(*surface.bsdf)) return std::nullopt;
    const auto light = lights_.connect(sensor, state, surface, sampler, rays);
    // Photons of other lights share with nobody.
    if (!light || light->emitter->isDelta() || light->emitter->isInfinite()) return std::nullopt;
    const float squared = sqr(light->direct.distance);
    return ArrivedLight{light->arrived.radiance * (squared / (squared + nearField)), light->arrived.time};
}

uint32_t DirectLight::paths(const Sensor& sensor, const SensorRecord& record, const PassInfo& pass) const {
    constexpr size_t PathsPerPass = 1 << 17, Least = 2, Most = 32, Looks = 1 << 14;
    constexpr double FewLit = 1.0 / 16.0; // below, as many paths as light is found with
    const size_t step = std::max(record.points.size() / Looks, size_t(1)), looks = record.points.size() / step;
    std::atomic<size_t> lit = 0;
    tbb::parallel_for(size_t(0), looks, [&](size_t k) {
        const SensorPoint& point = record.points[k * step];
        Sampler sampler(pass.seed, RandomStream::DirectLight, uint32_t(pass.firstSample), record.x.size() + k);
        const SurfaceInteraction surface = makeInteraction(scene_, point.hit, point.direction);
        SensorState state{Ray{point.hit.position - point.direction * point.hit.t, point.direction}, point.region};
        state.time = point.time - double(point.hit.t) / double(point.region.speed);
        state.interactions = point.interactions;
        uint64_t rays = 0;
        if (connect(sensor, 0.0f, state, surface, sampler, rays)) ++lit;
    });
    if (lit == 0) return 1;
    const double share = std::min(double(lit) / (FewLit * double(looks)), 1.0);
    return uint32_t(std::clamp(size_t(share * double(PathsPerPass)) / record.x.size(), Least, Most));
}

void DirectLight::add(const Sensor& sensor, const SensorRecord& record, float nearField, const PassInfo& pass,
                      Film& film, Statistics& statistics) const {
    const uint32_t paths = this->paths(sensor, record, pass);
    const float scale = 1.0f / (float(paths) * float(sensor.gate.frameWidth));
    tbb::parallel_for(0, record.height, [&](int y) {
        uint64_t rays = 0, nonFinite = 0;
        for (int x = 0; x < record.width; ++x) {
            Sampler sampler(pass.seed, RandomStream::DirectLight, uint32_t(pass.firstSample),
                            size_t(y) * size_t(record.width) + size_t(x));
            const SurfaceVisitor look{[&](const SensorState& state, const SurfaceInteraction& surface) {
                const auto light = connect(sensor, nearField, state, surface, sampler, rays);
                const int frame = light ? sensor.gate.frameOf(light->time) : -1;
                if (frame < 0) return;
                const Rgb radiance = light->radiance * (sensor.weight(light->time) * scale);
                if (isFinite(radiance))
                    film.passPixel(frame, x, y) += radiance;
                else
                    ++nonFinite;
            }};
            for (uint32_t k = 0; k < paths; ++k) {
                const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
                const Ray ray = scene_.camera.generateRay({x, y}, uFilter, uLens);
                rays += followSensorPath(scene_, {ray, scene_.cameraRegion}, rules_, sampler, look);
            }
        }
        statistics.add("rays", rays);
        statistics.add("non-finite samples", nonFinite);
    });
}

} // namespace tungsten::photon
