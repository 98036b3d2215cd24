#include "photon/light/LightPath.h"

#include "photon/surface/SurfaceConnections.h"

namespace tungsten::photon {

void LightPath::startAt(const Emitter& emitter) {
    time = emitter.emissionTime + culling->delays().sample(emitter, sampler);
}

bool LightPath::emitFrom(const Emitter& emitter, float probability, const Vec2f& uPosition) {
    const EmissionSample emission = sampleEmission(emitter, uPosition, sampler.next2D());
    power = emission.power / probability;
    startAt(emitter);
    region = context.scene.regionOf(emitter);
    ray = emission.ray;
    return !isBlack(power) && culling->mayContinue(ray.origin, time);
}

void LightPath::collide(const Vec3f& position, double length) {
    if (const Medium* medium = context.scene.medium(region)) counters.scatter(*medium);
    time += length / double(region.speed);
    ++bounce;
    ++consecutiveMedium;
    ray = Ray{position, ray.direction};
    connectable = true;
    fromLight = false;
}

double LightPath::distanceTo(const Vec3f& position) const {
    const Vec3f &a = ray.origin, &b = position;
    const Vec3d d(double(b.x) - double(a.x), double(b.y) - double(a.y), double(b.z) - double(a.z));
    return d.length();
}

bool LightPath::bears(const Rgb& carried) {
    if (isFinite(carried)) return !isBlack(carried);
    ++counters.nonFinite;
    return false;
}

bool LightPath::deposit(DepositList<Photon>& list, const Vec3f& position, const Rgb& carried, int medium) {
    if (!culling->mayCount(position, time)) return false;
    list.records.push_back({time, position, ray.direction, carried, uint16_t(bounce), int16_t(medium)});
    return true;
}

void LightPath::depositBeam(DepositList<PhotonBeam>& beams, const Medium& medium, float reach) {
    if (!bears(power) || !orderCounts(1)) return;
    storeBeam(beams, *culling, medium,
              {time, ray.origin, ray.direction, power, 0.0f, reach, uint16_t(bounce), int16_t(region.medium)});
}

bool LightPath::arriveOnSurface(const SurfaceHit& hit) {
    ++counters.surfaceEvents;
    time += double(hit.t) / double(region.speed);
    ++bounce;
    flights = 0;
    consecutiveMedium = 0;
    if (!culling->mayContinue(hit.position, time)) return false;
    surface = makeInteraction(context.scene, hit, ray.direction);
    if (!context.storeSurface || (surface.bsdf->lobes() & lobe::Smooth) == 0) return true;
    const float shading = std::abs(ray.direction.dot(surface.frame.n)), geometric = std::abs(ray.direction.dot(hit.ng));
    if (!(geometric > 0.0f)) return true;
    const bool connected = context.connects && connectable && receivesConnections(*surface.bsdf);
    if (connected && context.densityPhotons) deposit(deposits.surface, hit.position, Rgb(0.0f), -1);
    if (connected || foundBySensorPaths()) return true;
    const Rgb arriving = power * (shading / geometric);
    if (bears(arriving)) deposit(deposits.surface, hit.position, arriving, -1);
    return true;
}

bool LightPath::foundBySensorPaths() const {
    return context.glossySensorPaths && isGlossyOnly(*surface.bsdf) && (!fromLight || connectable);
}

bool LightPath::leaveSurface() {
    sampler.at(bounce, Draw::Direction);
    const auto exit =
        sampleExit(surface, surface.query(TransportMode::Photons), context.scene.transport.consistencyChecks, sampler);
    if (!exit) return false;
    counters.leave(exit->lobe);
    const Region ahead = regionBeyond(surface, exit->direction, region);
    const float shading = exit->straight() ? 1.0f : surface.photonShadingFactor(-ray.direction, exit->direction);
    if (!exit->straight()) {
        connectable = (exit->lobe & lobe::Smooth) != 0 && ahead.medium == region.medium && ahead.speed == region.speed;
        fromLight = fromLight && (exit->lobe & lobe::Smooth) == 0;
    }
    power = power * (exit->weight * shading);
    if (isBlack(power)) return false;
    region = ahead;
    ray = surface.hit.leave(exit->direction);
    return true;
}

FlightChain::Rules LightPath::chainRules() const {
    return {context.scene, *culling, std::get<Slices>(context.settings.primitive).classes, context.recordCounts};
}

void LightPath::leaveBall(DepositList<CollapsedFlights>& list, FlightChain& chain, const Vec3f& position) {
    Sampler own = records(RecordsOf::Surface);
    chain.leaveSurface(chainRules(), surface, {position, ray.direction, power, time, Infinity, bounce}, region, own,
                       list);
}

} // namespace tungsten::photon
