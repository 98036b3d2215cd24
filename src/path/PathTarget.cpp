#include "path/PathTarget.h"

#include "tungsten/scene/LightChoice.h"

namespace tungsten::path {

namespace {

Distribution1D targetDistribution(const Scene& scene, TargetChoice::Emitters emitters,
                                  const std::vector<bool>& leftOut) {
    if (emitters == TargetChoice::Emitters::SingleDirections)
        return emitterDistribution(
            scene, [](const Emitter& emitter) { return emitter.isDelta(); }, leftOut);
    return emitterDistribution(
        scene, [](const Emitter& emitter) { return !emitter.isInfinite(); }, leftOut);
}

} // namespace

TargetChoice::TargetChoice(const Scene& scene, Emitters emitters, const std::vector<bool>& leftOut)
    : scene_(scene), distribution_(targetDistribution(scene, emitters, leftOut)) {
    for (const Emitter& emitter : scene.emitters) radii_.push_back(2.0f * boundingSphere(emitter).radius);
    for (size_t i = 0; any() && i < radii_.size(); ++i) count_ += probability(i) > 0.0f ? 1 : 0;
}

std::optional<PathTarget> TargetChoice::sample(float u, Sampler& sampler, const PassWatch& watch,
                                               PathCounters& counters) const {
    if (!any()) return std::nullopt;
    const auto chosen = distribution_.sample(u);
    const Emitter& emitter = scene_.emitters[chosen.index];
    const float probability = chosen.probability;
    const Vec2f uPosition = sampler.next2D();
    const transport::Vertex point(scene_, emitter, sampleEmissionPoint(emitter, uPosition));
    PathTarget target{{point, Rgb(1.0f / probability)}, &emitter, int(chosen.index), probability, emitter.emissionTime};
    if (emitter.isDelta())
        return scatterLaser(target, sampleEmission(emitter, uPosition, {0.5f, 0.5f}), sampler, watch, counters);
    target.reach = radii_[chosen.index];
    return target;
}

bool TargetChoice::hasOthers(const Emitter& emitter) {
    return !emitter.isDelta() && !emitter.isInfinite() && boundingSphere(emitter).radius > 0.0f;
}

std::optional<PathTarget> TargetChoice::another(const PathTarget& target, Sampler& sampler) const {
    if (target.index < 0 || !(target.reach > 0.0f)) return std::nullopt;
    PathTarget other = target;
    other.vertex = {scene_, *target.emitter, sampleEmissionPoint(*target.emitter, sampler.next2D())};
    return other;
}

/// Light on its straight or specular way from the emitter to its first scattering vertex.
struct TargetChoice::Laser {
    Ray ray;
    Region region;
};

std::optional<PathTarget> TargetChoice::scatterLaser(PathTarget target, const EmissionSample& emission,
                                                     Sampler& sampler, const PassWatch& watch,
                                                     PathCounters& counters) const {
    target.index = -1;
    target.power = emission.power / target.probability;
    Laser laser{emission.ray, scene_.regionOf(*target.emitter)};
    while (target.interactions + 1 < scene_.transport.maxBounces && !isBlack(target.power)) {
        counters.step(watch);
        const Medium* medium = scene_.medium(laser.region);
        FlightSample flight{Infinity, true, Rgb(1.0f), 1.0f};
        sampler.at(target.interactions + 1, Draw::Flight);
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
            target.vertex = {*medium, laser.ray.at(length), laser.ray.direction, laser.region};
            ++target.mediumScatters;
            return target;
        }
        if (medium)
            target.power = target.power * (medium->transmittance(length) / probabilityFlightExits(*medium, length));
        const Meeting meeting = meetSurface(target, laser, *hit, sampler);
        if (meeting == Meeting::Scattered) return target;
        if (meeting == Meeting::Absorbed) return std::nullopt;
    }
    return std::nullopt;
}

/// Becomes a virtual source or goes on along a specular or forward lobe, by chance where both can be.
auto TargetChoice::meetSurface(PathTarget& target, Laser& laser, const SurfaceHit& hit, Sampler& sampler) const
    -> Meeting {
    const SurfaceInteraction surface = makeInteraction(scene_, hit, laser.ray.direction);
    const LobeMask lobes = surface.bsdf->lobes(), onward = lobes & (lobe::Specular | lobe::Forward);
    const float scatters = (lobes & lobe::Smooth) == 0 ? 0.0f : onward == 0 ? 1.0f : 0.5f;
    sampler.at(target.interactions, Draw::Roulette);
    if (sampler.next1D() < scatters) {
        target.power = target.power / scatters;
        target.vertex = {scene_, surface, laser.ray.direction, TransportMode::Photons, laser.region};
        return Meeting::Scattered;
    }
    if (onward == 0) return Meeting::Absorbed;
    sampler.at(target.interactions, Draw::Direction);
    const auto exit = sampleExit(surface, surface.query(TransportMode::Photons, onward), false, sampler);
    if (!exit) return Meeting::Absorbed;
    const float shading = exit->straight() ? 1.0f : surface.photonShadingFactor(-laser.ray.direction, exit->direction);
    target.power = target.power * (exit->weight * (shading / (1.0f - scatters)));
    laser.region = regionBeyond(surface, exit->direction, laser.region);
    laser.ray = hit.leave(exit->direction);
    return Meeting::WentOn;
}

} // namespace tungsten::path
