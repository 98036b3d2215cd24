#include "photon/light/PhotonWalk.h"

#include "photon/surface/SurfaceConnections.h"

namespace tungsten::photon {

void PhotonWalk::run() {
    if (emit()) goOn();
    endChain();
}

void PhotonWalk::goOn() {
    // A photon with bounce b takes part in paths of at least b interactions.
    const int mostBounces = std::min(scene_.transport.maxBounces - 1, MostPhotonBounces);
    while (bounce_ < mostBounces) {
        ++counters_.rays;
        const auto hit = scene_.geometry->intersect(ray_);
        if (const Medium* medium = scene_.medium(region_)) {
            const float reach = hit ? hit->t : Infinity;
            if (medium->scatters() && ++flights_ > medium->maxBounces) return;
            if (context_.storeVolume && medium->scatters())
                std::visit([&](auto& list) { depositFlight(list, *medium, reach); }, deposits_.volume);
            const FlightSample flight = sampleFlight(*medium, reach, sampler_);
            power_ = power_ * flight.weight;
            if (!flight.exited) {
                if (!scatterInMedium(*medium, flight.distance)) return;
                continue;
            }
        }
        if (!hit || !scatterOnSurface(*hit)) return;
    }
}

bool PhotonWalk::emit() {
    const auto chosen = context_.emitters.sample(sampler_.next1D());
    return emitFrom(scene_.emitters[chosen.index], chosen.probability);
}

bool PhotonWalk::emitFrom(const Emitter& emitter, float probability) {
    const Vec2f uPosition = sampler_.next2D();
    const EmissionSample emission = sampleEmission(emitter, uPosition, sampler_.next2D());
    power_ = emission.power / probability;
    time_ = emitter.emissionTime;
    region_ = scene_.regionOf(emitter);
    ray_ = emission.ray;
    if (std::holds_alternative<DepositList<CollapsedFlights>>(deposits_.volume))
        chain_.beginAt(scene_, emitter, probability, uPosition);
    return !isBlack(power_) && arrival_->mayContinue(ray_.origin, time_);
}

bool PhotonWalk::bears(const Rgb& power) {
    if (isFinite(power)) return !isBlack(power);
    ++counters_.nonFinite;
    return false;
}

bool PhotonWalk::deposit(DepositList<Photon>& list, const Vec3f& position, const Rgb& power, int medium) {
    if (!arrival_->mayCount(position, time_)) return false;
    list.records.push_back({time_, position, ray_.direction, power, uint16_t(bounce_), int16_t(medium)});
    return true;
}

void PhotonWalk::depositFlight(DepositList<Photon>&, const Medium&, float) {}

void PhotonWalk::depositFlight(DepositList<PhotonBeam>& beams, const Medium& medium, float reach) {
    if (!bears(power_) || (!context_.settings.lowOrderScattering && consecutiveMedium_ == 0)) return;
    storeBeam(beams, *arrival_, medium,
              {time_, ray_.origin, ray_.direction, power_, 0.0f, reach, uint16_t(bounce_), int16_t(region_.medium)});
}

void PhotonWalk::depositVertex(DepositList<Photon>& points, const Vec3f& position) {
    const bool orderCounts = context_.settings.lowOrderScattering || consecutiveMedium_ > 1;
    if (!orderCounts || !bears(power_)) return;
    ++counters_.volumeDeposits;
    if (deposit(points, position, power_, region_.medium)) ++counters_.countingDeposits;
}

void PhotonWalk::depositVertex(DepositList<PhotonBeam>&, const Vec3f&) {}

void PhotonWalk::depositFlight(DepositList<CollapsedFlights>& flights, const Medium&, float reach) {
    chain_.fly({scene_, *arrival_, std::get<Slices>(context_.settings.primitive).classes},
               {ray_.origin, ray_.direction, power_, time_, reach, bounce_}, region_.medium, sampler_, flights);
}

void PhotonWalk::depositVertex(DepositList<CollapsedFlights>& flights, const Vec3f& position) {
    chain_.scatter({scene_, *arrival_, std::get<Slices>(context_.settings.primitive).classes},
                   {position, ray_.direction, power_, time_, Infinity, bounce_}, sampler_, flights);
}

void PhotonWalk::endChain() {
    if (auto* flights = std::get_if<DepositList<CollapsedFlights>>(&deposits_.volume))
        chain_.end({scene_, *arrival_, std::get<Slices>(context_.settings.primitive).classes}, sampler_, *flights);
}

bool PhotonWalk::scatterInMedium(const Medium& medium, float distance) {
    const Vec3f position = ray_.at(distance);
    time_ += double(distance) / double(region_.speed);
    ++bounce_;
    ++consecutiveMedium_;
    if (!arrival_->mayContinue(position, time_)) return false;
    if (context_.storeVolume) std::visit([&](auto& list) { depositVertex(list, position); }, deposits_.volume);
    connectable_ = true;
    fromLight_ = false;
    ray_ = Ray{position, medium.phase.sample(ray_.direction, sampler_.next2D())};
    return true;
}

bool PhotonWalk::arriveOnSurface(const SurfaceHit& hit) {
    endChain();
    time_ += double(hit.t) / double(region_.speed);
    ++bounce_;
    flights_ = 0;
    consecutiveMedium_ = 0;
    if (!arrival_->mayContinue(hit.position, time_)) return false;
    surface_ = makeInteraction(scene_, hit, ray_.direction);
    if (!context_.storeSurface || (surface_.bsdf->lobes() & lobe::Smooth) == 0) return true;
    const float shading = std::abs(ray_.direction.dot(surface_.frame.n)),
                geometric = std::abs(ray_.direction.dot(hit.ng));
    if (!(geometric > 0.0f)) return true;
    const bool connected = context_.connects && connectable_ && receivesConnections(*surface_.bsdf);
    if (connected && context_.densityPhotons) deposit(deposits_.surface, hit.position, Rgb(0.0f), -1);
    if (connected || foundBySensorPaths()) return true;
    const Rgb power = power_ * (shading / geometric);
    if (bears(power)) deposit(deposits_.surface, hit.position, power, -1);
    return true;
}

bool PhotonWalk::foundBySensorPaths() const {
    return context_.glossySensorPaths && isGlossyOnly(*surface_.bsdf) && (!fromLight_ || connectable_);
}

bool PhotonWalk::leaveSurface() {
    const auto exit =
        sampleExit(surface_, surface_.query(TransportMode::Photons), scene_.transport.consistencyChecks, sampler_);
    if (!exit) return false;
    const Region ahead = regionBeyond(surface_, exit->direction, region_);
    if (!exit->straight()) {
        power_ = power_ * surface_.photonShadingFactor(-ray_.direction, exit->direction);
        connectable_ =
            (exit->lobe & lobe::Smooth) != 0 && ahead.medium == region_.medium && ahead.speed == region_.speed;
        fromLight_ = fromLight_ && (exit->lobe & lobe::Smooth) == 0;
    }
    power_ = power_ * exit->weight;
    if (isBlack(power_)) return false;
    region_ = ahead;
    ray_ = surface_.hit.leave(exit->direction);
    return true;
}

} // namespace tungsten::photon
