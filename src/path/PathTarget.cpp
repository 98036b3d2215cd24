#include "path/PathTarget.h"

#include "tungsten/scene/LightChoice.h"

namespace tungsten::path {

namespace {

Distribution1D targetDistribution(const Scene& scene, TargetChoice::Emitters emitters) {
    if (emitters == TargetChoice::Emitters::SingleDirections)
        return emitterDistribution(scene, [](const Emitter& emitter) { return emitter.isDelta(); });
    return emitterDistribution(scene, [](const Emitter& emitter) { return !emitter.isInfinite(); });
}

} // namespace

Rgb PathTarget::intensity(const Vec3f& direction) const {
    if (source) return power * source->scattering(direction);
    if (const float area = emittingArea(*emitter); area > 0.0f)
        return emittedRadiance(*emitter, point.uv, point.normal, direction) *
               (std::abs(direction.dot(point.normal)) * area / probability);
    return emittedIntensity(*emitter, point, direction) / probability;
}

std::optional<transport::ConnectionEnd> PathTarget::seenFrom(const Vec3f& position) const {
    const Vec3f offset = point.position - position;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return std::nullopt;
    const Vec3f direction = offset / distance;
    return transport::ConnectionEnd{direction, distance, intensity(-direction) / sqr(distance), point.margin()};
}

TargetChoice::TargetChoice(const Scene& scene, Emitters emitters)
    : scene_(scene), distribution_(targetDistribution(scene, emitters)) {
    for (const Emitter& emitter : scene.emitters) radii_.push_back(2.0f * boundingSphere(emitter).radius);
    for (size_t i = 0; any() && i < radii_.size(); ++i) count_ += probability(i) > 0.0f ? 1 : 0;
}

std::optional<PathTarget> TargetChoice::sample(float u, Sampler& sampler, PathCounters& counters) const {
    if (!any()) return std::nullopt;
    const auto chosen = distribution_.sample(u);
    const Emitter& emitter = scene_.emitters[chosen.index];
    PathTarget target;
    target.emitter = &emitter;
    target.probability = chosen.probability;
    target.start = emitter.emissionTime;
    if (emitter.isDelta()) return scatterLaser(std::move(target), sampler, counters);
    target.index = int(chosen.index);
    target.point = sampleEmissionPoint(emitter, sampler.next2D());
    target.surrounding = emitter.medium;
    target.reach = radii_[chosen.index];
    return target;
}

/// Light on its straight or specular way from the emitter to its first scattering vertex.
struct TargetChoice::Laser {
    Ray ray;
    Region region;
};

std::optional<PathTarget> TargetChoice::scatterLaser(PathTarget target, Sampler& sampler,
                                                     PathCounters& counters) const {
    const EmissionSample emission = sampleEmission(*target.emitter, sampler.next2D(), Vec2f(0.5f, 0.5f));
    target.power = emission.power / target.probability;
    Laser laser{emission.ray, scene_.regionOf(*target.emitter)};
    while (target.interactions + 1 < scene_.transport.maxBounces && !isBlack(target.power)) {
        const Medium* medium = scene_.medium(laser.region);
        FlightSample flight{Infinity, true, Rgb(1.0f), 1.0f};
        if (medium) flight = sampleFlight(*medium, Infinity, sampler);
        laser.ray.tMax = flight.distance;
        ++counters.rays;
        const auto hit = scene_.geometry->intersect(laser.ray);
        if (!hit && flight.exited) return std::nullopt;
        const float length = hit ? hit->t : flight.distance;
        target.start += double(length) / double(laser.region.speed);
        ++target.interactions;
        if (!hit) {
            target.power = target.power * flight.weight;
            target.point = {laser.ray.at(length), laser.ray.direction, {0.0f, 0.0f}};
            target.source.emplace(*medium, target.point.position, laser.ray.direction, laser.region);
            target.surrounding = laser.region.medium;
            ++target.mediumScatters;
            return target;
        }
        if (medium)
            target.power = target.power * (medium->transmittance(length) / probabilityFlightExits(*medium, length));
        if (!meetSurface(target, laser, *hit, sampler)) return std::nullopt;
        if (target.source) {
            target.surrounding = laser.region.medium;
            return target;
        }
    }
    return std::nullopt;
}

/// Becomes a virtual source or goes on along a specular or forward lobe, by chance where both can be; false: absorbed.
bool TargetChoice::meetSurface(PathTarget& target, Laser& laser, const SurfaceHit& hit, Sampler& sampler) const {
    const SurfaceInteraction surface = makeInteraction(scene_, hit, laser.ray.direction);
    const LobeMask lobes = surface.bsdf->lobes(), onward = lobes & (lobe::Specular | lobe::Forward);
    const float scatters = (lobes & lobe::Smooth) == 0 ? 0.0f : onward == 0 ? 1.0f : 0.5f;
    if (sampler.next1D() < scatters) {
        target.power = target.power / scatters;
        target.point = {hit.position, hit.ng, hit.uv, hit.error};
        target.source.emplace(scene_, surface, laser.ray.direction, TransportMode::Photons, laser.region);
        return true;
    }
    if (onward == 0) return false;
    const auto exit = sampleExit(surface, surface.query(TransportMode::Photons, onward), false, sampler);
    if (!exit) return false;
    const float shading = exit->straight() ? 1.0f : surface.photonShadingFactor(-laser.ray.direction, exit->direction);
    target.power = target.power * exit->weight * (shading / (1.0f - scatters));
    laser.region = regionBeyond(surface, exit->direction, laser.region);
    laser.ray = hit.leave(exit->direction);
    return true;
}

} // namespace tungsten::path
