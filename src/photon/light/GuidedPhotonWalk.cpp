#include "photon/light/GuidedPhotonWalk.h"

#include "photon/light/EmissionDirections.h"

namespace tungsten::photon {

namespace {

/// Between points as they are stored, so that times are those of the path that is gathered.
double distanceBetween(const Vec3f& a, const Vec3f& b) {
    const Vec3d d(double(b.x) - double(a.x), double(b.y) - double(a.y), double(b.z) - double(a.z));
    return d.length();
}

/// Of light that goes everywhere alike, per solid angle.
constexpr float InSphere = 0.25f * InvPi;

/// Balance heuristic between a control vertex's density along the ray and a free flight's.
float controlVertexShare(float controlVertexPdf, float sigmaT, float distance) {
    return controlVertexPdf / (controlVertexPdf + sigmaT * std::exp(-sigmaT * distance));
}

} // namespace

GuidedPhotonWalk::GuidedPhotonWalk(const WalkContext& context, const PhotonGuidance& guidance,
                                   const SurfaceConnections* connections, Sampler sampler, uint64_t path,
                                   Deposits& deposits, WalkCounters& counters)
    : PhotonWalk(context, sampler, deposits, counters), guidance_(guidance), connections_(connections),
      gate_(guidance.gate()) {
    if (guidance.choosesFrames()) aimAtFrame(path);
}

void GuidedPhotonWalk::aimAtFrame(uint64_t path) {
    const int frame = guidance_.frames().stratified(path, context_.frameShift);
    gate_ = guidance_.frames().frame(frame);
    arrival_ = &context_.frameArrivals[size_t(frame)];
}

void GuidedPhotonWalk::run() {
    if (emit()) goOn();
}

void GuidedPhotonWalk::goOn() {
    const int mostBounces = std::min(scene_.transport.maxBounces - 1, MostPhotonBounces);
    while (bounce_ < mostBounces) {
        const darts::Guide* guide = guidance_.guide(region_);
        if (guide) {
            if (!crossMedium(*scene_.medium(region_), *guide)) return;
            continue;
        }
        ++counters_.rays;
        const auto hit = scene_.geometry->intersect(ray_);
        if (!hit) return;
        if (const Medium* medium = scene_.medium(region_)) power_ = power_ * medium->transmittance(hit->t);
        looked_ = connected_ = false;
        if (!meetSurface(*hit)) return;
    }
}

bool GuidedPhotonWalk::emit() {
    const auto chosen = context_.emitters.sample(sampler_.next1D());
    const Emitter& emitter = scene_.emitters[chosen.index];
    const float frames = guidance_.choosesFrames() ? float(guidance_.frames().frames) : 1.0f;
    if (emitter.isDelta() || emitter.isInfinite()) {
        if (!emitFrom(emitter, chosen.probability)) return false;
        power_ = power_ * frames;
        return true;
    }
    time_ = emitter.emissionTime;
    region_ = scene_.regionOf(emitter);
    power_ = Rgb(frames / chosen.probability);
    const darts::Guide* guide = guidance_.guide(region_);
    return emitFromPoint(emitter, guide && guide->settings().guideEmission ? guide : nullptr);
}

bool GuidedPhotonWalk::emitFromPoint(const Emitter& emitter, const darts::Guide* guide) {
    const SurfaceSample start = sampleEmissionPoint(emitter, sampler_.next2D());
    ray_ = Ray{start.position, Vec3f(0.0f)};
    connectable_ = true;
    if (!arrival_->mayContinue(ray_.origin, time_)) return false;
    connectToSurfaces(start.margin(), InSphere * meanComponent(emitterPower(emitter)),
                      [&](const Vec3f& direction) { return emittedIntensity(emitter, start, direction); });
    // What is guided aims at the camera itself.
    const EmissionDirections own(emitter, start, guide ? std::span<const transport::BodySphere>() : guidance_.bodies());
    float inversePdf = 0.0f;
    if (guide) {
        if (!look(*guide, {start.position, start.margin()})) return false;
        inversePdf = redirect(*guide, own);
    } else {
        const float u = sampler_.next1D(), v = sampler_.next1D();
        const darts::Vec3 direction = own.sample(u, v);
        ray_.direction = darts::to<Vec3f>(direction);
        inversePdf = 1.0f / own.pdf(direction);
    }
    ray_ = start.leave(ray_.direction);
    power_ = power_ * emittedIntensity(emitter, start, ray_.direction) * inversePdf;
    return !isBlack(power_);
}

template <typename Scattering>
void GuidedPhotonWalk::connectToSurfaces(const SurfaceMargin& margin, float usual, const Scattering& scattering) {
    if (!connections_ || !bears(power_)) return;
    const LightVertex vertex{ray_.origin, margin, time_, bounce_, region_, power_, usual};
    if (connections_->hasTarget())
        connections_->connect(vertex, gate_, scattering, sampler_, draws_, deposits_.arrivals, counters_.rays);
    else
        deposits_.worths.push_back(connections_->worth(vertex, gate_));
}

bool GuidedPhotonWalk::meetSurface(const SurfaceHit& hit) {
    if (!arriveOnSurface(hit)) return false;
    if (connections_ && (surface_.bsdf->lobes() & lobe::Smooth) != 0) {
        const Vec3f before = ray_.direction;
        const Region behind = region_;
        ray_.origin = hit.position;
        // Light leaves to the side of the direction; a boundary's other side is another region.
        connectToSurfaces(hit.margin(), 2.0f * InSphere, [&](const Vec3f& direction) {
            if (!surface_.consistent(direction, scene_.transport.consistencyChecks)) return Rgb(0.0f);
            const Region ahead = regionBeyond(surface_, direction, behind);
            if (ahead.medium != behind.medium || ahead.speed != behind.speed) return Rgb(0.0f);
            return surface_.bsdf->eval(surface_.query(TransportMode::Photons, lobe::Smooth), surface_.wi,
                                       surface_.frame.toLocal(direction)) *
                   surface_.photonShadingFactor(-before, direction);
        });
    }
    return leaveSurface();
}

bool GuidedPhotonWalk::look(const darts::Guide& guide, const transport::Start& start) {
    residual_ = guidance_.residual(start, region_, time_, gate_, counters_.rays);
    looked_ = true;
    // Along a direction that is fixed the surface ahead bounds the lengths: they are drawn when it is known.
    connected_ = guide.settings().lengthFirst && !(start.ahead.length2() > 0.0f);
    if (connected_) connection_ = drawConnection(guide, residual_);
    // A density of 0: the response is over, or the delta gate, but surfaces may still be seen in its kernel.
    return residual_.alive() && (!connected_ || connection_.inversePdf > 0.0f || guidance_.meetsDeltaGate());
}

darts::ConnectionSample GuidedPhotonWalk::drawConnection(const darts::Guide& guide, const darts::Residual& residual) {
    if (guidance_.meetsDeltaGate() && storesVertices()) return guidance_.onDeltaGate(residual);
    return guide.sampleConnection(residual, sampler_.next1D(), guidance_.response(time_));
}

template <typename Scatterer>
float GuidedPhotonWalk::redirect(const darts::Guide& guide, const Scatterer& scatterer) {
    const auto random = [this] { return sampler_.next1D(); };
    const darts::DirectionSample next =
        guide.sampleDirection(residual_, connection_, scatterer, guidance_.view(), random);
    ray_.direction = darts::to<Vec3f>(next.direction);
    return next.inversePdf;
}

bool GuidedPhotonWalk::survives(const darts::Guide& guide) {
    if (!(guide.settings().roulette > 0.0f)) return true;
    const float useful = guide.logUsefulness(residual_, meanComponent(power_));
    // Models do not compare: what one promises, another may keep.
    if (!started_ || rouletteMedium_ != region_.medium || rouletteWay_ != residual_.way) {
        firstUsefulness_ = useful;
        started_ = true;
        rouletteMedium_ = region_.medium;
        rouletteWay_ = residual_.way;
        return true;
    }
    const float survival = guide.survival(useful, firstUsefulness_);
    if (survival >= 1.0f) return true;
    if (sampler_.next1D() >= survival) return false;
    power_ = power_ / survival;
    return true;
}

bool GuidedPhotonWalk::crossMedium(const Medium& medium, const darts::Guide& guide) {
    if (++flights_ > medium.maxBounces) return false;
    if (!looked_ && (!look(guide, transport::Start::along(ray_)) || !survives(guide))) return false; // after a surface
    const darts::Heading heading = residual_.heading(darts::vec3(ray_.direction));
    const float h = heading.h;
    ray_.tMax = guide.distance().bound(residual_, h);
    ++counters_.rays;
    const auto hit = scene_.geometry->intersect(ray_);
    ray_.tMax = Infinity;
    const float surface = hit ? hit->t : Infinity;
    if (hit && residual_.way == darts::Way::Out && residual_.exit.connects)
        residual_.exit.leaveOdds = guidance_.leaveOdds(region_, ray_.direction, *hit);
    const Flight flight{medium, guide, h, surface};
    if (context_.storeVolume) std::visit([&](auto& list) { leaveOn(flight, list); }, deposits_.volume);

    const auto random = [this] { return sampler_.next1D(); };
    const darts::DistanceSample step = guide.sampleDistance(residual_, heading, surface, darts::vec3(power_), random);
    power_ = power_ * Rgb(step.transmittanceOverPdf.x, step.transmittanceOverPdf.y, step.transmittanceOverPdf.z);
    looked_ = connected_ = false;
    if (isBlack(power_)) return false;
    if (step.surface) return meetSurface(*hit);
    power_ = power_ * medium.sigmaS();
    if (context_.storeVolume) std::visit([&](auto& list) { leaveAt(step.distance, flight, list); }, deposits_.volume);
    return scatter(medium, guide, step.distance);
}

bool GuidedPhotonWalk::scatter(const Medium& medium, const darts::Guide& guide, float distance) {
    const Vec3f position = ray_.at(distance), before = ray_.direction;
    time_ += distanceBetween(ray_.origin, position) / double(region_.speed);
    ++bounce_;
    ++consecutiveMedium_;
    ray_ = Ray{position, before};
    connectable_ = true;
    fromLight_ = false;
    if (!look(guide, {position}) || !survives(guide)) return false;
    if (flights_ < medium.maxBounces) // else no flight would leave here
        connectToSurfaces({}, InSphere,
                          [&](const Vec3f& direction) { return Rgb(medium.phase.eval(before, direction)); });
    split(guide, medium, before);
    return leave(medium, guide, before);
}

bool GuidedPhotonWalk::leave(const Medium& medium, const darts::Guide& guide, const Vec3f& before) {
    const float inversePdf = redirect(guide, darts::PhaseScatterer{medium.phase, before});
    power_ = power_ * (medium.phase.eval(before, ray_.direction) * inversePdf);
    return !isBlack(power_);
}

void GuidedPhotonWalk::split(const darts::Guide& guide, const Medium& medium, const Vec3f& before) {
    const int copies = splits_.copies(guide.splits(residual_));
    power_ = power_ / float(copies);
    for (int i = 1; i < copies; ++i) {
        GuidedPhotonWalk copy(*this);
        if (copy.leave(medium, guide, before)) copy.goOn();
        sampler_ = copy.sampler_;
        if (connected_) connection_ = drawConnection(guide, residual_);
    }
}

void GuidedPhotonWalk::leaveOn(const Flight& flight, DepositList<Photon>& points) {
    const auto& [medium, guide, h, surface] = flight;
    if (!guide.settings().elliptical) return;
    if (!context_.settings.lowOrderScattering && consecutiveMedium_ == 0) return;
    reachable_ = residual_;
    if (!connected_) {
        reachable_ = darts::Guide::beforeSurface(residual_, h, surface);
        if (!reachable_.alive()) return;
        connection_ = drawConnection(guide, reachable_);
    }
    const auto vertex = guide.controlVertex(residual_, connection_, h, surface);
    if (!vertex) return;
    ++counters_.controlVertices;
    const Vec3f position = ray_.at(vertex->distance);
    Rgb power = power_ * medium.sigmaS() * medium.transmittance(vertex->distance) * vertex->inversePdf;
    if (storesPhotons())
        power = power * controlVertexShare(1.0f / vertex->inversePdf, meanComponent(medium.sigmaT()), vertex->distance);
    // In its frame but for rounding, which goes both ways: a test of the frame would only lose what it moves.
    store(points, context_.arrival, position, time_ + distanceBetween(ray_.origin, position) / double(region_.speed),
          power, bounce_ + 1);
}

void GuidedPhotonWalk::leaveOn(const Flight& flight, DepositList<PhotonBeam>& beams) {
    const Medium& medium = flight.medium;
    if (!guidance_.directView()) return depositFlight(beams, medium, flight.surface);
    if (!bears(power_) || (!context_.settings.lowOrderScattering && consecutiveMedium_ == 0)) return;
    const FlightPart seen = guidance_.view().seenPart(ray_.origin, ray_.direction, context_.settings.volumeReach());
    const float end = std::min(flight.surface, float(seen.end));
    if (!(float(seen.start) < end)) return;
    storeBeam(beams, *arrival_, medium,
              {time_, ray_.origin, ray_.direction, power_, float(seen.start), end, uint16_t(bounce_),
               int16_t(region_.medium)});
}

void GuidedPhotonWalk::leaveAt(float distance, const Flight& flight, DepositList<Photon>& points) {
    const auto& [medium, guide, h, surface] = flight;
    if (!storesPhotons() && guide.settings().elliptical) return;
    if (!context_.settings.lowOrderScattering && consecutiveMedium_ == 0) return;
    float share = 0.0f;
    if (guide.settings().elliptical)
        share = controlVertexShare(guide.pdfControlVertex(reachable_, h, distance), meanComponent(medium.sigmaT()),
                                   distance);
    const Vec3f position = ray_.at(distance);
    store(points, *arrival_, position, time_ + distanceBetween(ray_.origin, position) / double(region_.speed),
          power_ * (1.0f - share), bounce_ + 1);
}

void GuidedPhotonWalk::leaveAt(float, const Flight&, DepositList<PhotonBeam>&) {}

void GuidedPhotonWalk::store(DepositList<Photon>& points, const ArrivalCulling& arrival, const Vec3f& position,
                             double time, const Rgb& power, int bounce) {
    if (!bears(power) || bounce > MostPhotonBounces) return;
    if (guidance_.directView() && !guidance_.view().sees(position, context_.settings.volumeReach())) return;
    ++counters_.volumeDeposits;
    if (!arrival.mayCount(position, time)) return;
    ++counters_.countingDeposits;
    points.records.push_back({time, position, ray_.direction, power, uint16_t(bounce), int16_t(region_.medium)});
}

} // namespace tungsten::photon
