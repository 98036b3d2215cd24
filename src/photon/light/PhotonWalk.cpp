#include "photon/light/PhotonWalk.h"

namespace tungsten::photon {

void PhotonWalk::run() {
    if (emit()) goOn();
    leaveRegion();
}

void PhotonWalk::goOn() {
    while (path_.mayBounce()) {
        path_.counters.step(path_.context.watch);
        ++path_.counters.rays;
        const auto hit = scene_.geometry->intersect(path_.ray);
        if (const Medium* medium = scene_.medium(path_.region)) {
            const float reach = hit ? hit->t : Infinity;
            path_.counters.fly(*medium);
            if (medium->scatters() && ++path_.flights > medium->maxBounces) return;
            if (path_.context.storeVolume && medium->scatters())
                std::visit([&](auto& list) { depositFlight(list, *medium, reach); }, path_.deposits.volume);
            path_.sampler.at(path_.bounce + 1, Draw::Flight);
            const FlightSample flight = sampleFlight(*medium, reach, path_.sampler);
            path_.power = path_.power * flight.weight;
            if (!flight.exited) {
                if (!scatterInMedium(*medium, flight.distance)) return;
                continue;
            }
        }
        if (!hit || !scatterOnSurface(*hit)) return;
    }
}

bool PhotonWalk::emit() {
    const auto chosen = path_.context.emitters.sample(path_.sampler.next1D());
    const Emitter& emitter = scene_.emitters[chosen.index];
    const Vec2f uPosition = path_.sampler.next2D();
    std::visit([&](auto& list) { beginChain(list, emitter, chosen.probability, uPosition); }, path_.deposits.volume);
    return path_.emitFrom(emitter, chosen.probability, uPosition);
}

void PhotonWalk::depositFlight(DepositList<Photon>&, const Medium&, float) {}

void PhotonWalk::depositFlight(DepositList<PhotonBeam>& beams, const Medium& medium, float reach) {
    path_.depositBeam(beams, medium, reach);
}

void PhotonWalk::depositVertex(DepositList<Photon>& points, const Vec3f& position) {
    if (!path_.orderCounts() || !path_.bears(path_.power)) return;
    ++path_.counters.volumeDeposits;
    if (path_.deposit(points, position, path_.power, path_.region.medium)) ++path_.counters.countingDeposits;
}

void PhotonWalk::depositVertex(DepositList<PhotonBeam>&, const Vec3f&) {}

void PhotonWalk::depositFlight(DepositList<CollapsedFlights>& flights, const Medium&, float reach) {
    Sampler own = path_.records(LightPath::RecordsOf::Flight);
    chain_.fly(path_.chainRules(),
               {path_.ray.origin, path_.ray.direction, path_.power, path_.time, reach, path_.bounce},
               path_.region.medium, own, flights);
}

void PhotonWalk::depositVertex(DepositList<CollapsedFlights>& flights, const Vec3f& position) {
    Sampler own = path_.records(LightPath::RecordsOf::Vertex);
    chain_.scatter(path_.chainRules(), {position, path_.ray.direction, path_.power, path_.time, Infinity, path_.bounce},
                   own, flights);
}

void PhotonWalk::beginChain(DepositList<CollapsedFlights>&, const Emitter& emitter, float probability,
                            const Vec2f& uPosition) {
    chain_.beginAt(scene_, emitter, probability, uPosition);
}

void PhotonWalk::endChain(DepositList<CollapsedFlights>& flights) {
    Sampler own = path_.records(LightPath::RecordsOf::End);
    chain_.end(path_.chainRules(), own, flights);
}

void PhotonWalk::leaveRegion() {
    std::visit([&](auto& list) { endChain(list); }, path_.deposits.volume);
}

bool PhotonWalk::scatterOnSurface(const SurfaceHit& hit) {
    leaveRegion();
    if (!path_.arriveOnSurface(hit)) return false;
    path_.leaveOnSurface(chain_, hit.position);
    return path_.leaveSurface();
}

bool PhotonWalk::scatterInMedium(const Medium& medium, float distance) {
    path_.collide(path_.ray.at(distance), double(distance));
    const Vec3f position = path_.ray.origin;
    if (!path_.culling->mayContinue(position, path_.time)) return false;
    if (path_.context.storeVolume)
        std::visit([&](auto& list) { depositVertex(list, position); }, path_.deposits.volume);
    path_.sampler.at(path_.bounce, Draw::Direction);
    path_.ray.direction = medium.phase.sample(path_.ray.direction, path_.sampler.next2D());
    return true;
}

} // namespace tungsten::photon
