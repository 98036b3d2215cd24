#include "photon/light/DepositVisitor.h"

#include "photon/Tuning.h"
#include "photon/light/StepsToCamera.h"

#include "transport/Balance.h"

namespace tungsten::photon {

using transport::Ahead;
using transport::Flight;
using transport::Vertex;
using transport::WalkVertex;
using transport::Way;

namespace {

/// Density per solid angle of light that goes everywhere evenly.
constexpr float InSphere = 0.25f * InvPi;

/// Density per length, for weights, of an ordinary photon at this distance along a flight.
float pdfPhoton(const Medium& medium, float distance) {
    return transport::pdfFreeFlight(meanComponent(medium.sigmaT()), distance);
}

StepRules rulesOf(const PhotonContext& context) {
    const bool storesVertices =
        context.storeVolume && std::visit([](const auto& p) { return p.AtVertices; }, context.settings.primitive);
    return {storesVertices, context.balance};
}

} // namespace

// ---- The walk's hooks

bool DepositVisitor::ahead(PathState& path, auto& steps, const Ahead& ahead) {
    if (trail_) trail_->fly(path, ahead);
    if (context_->storeVolume && ahead.medium && ahead.medium->scatters())
        std::visit([&](auto& list) { depositOnFlight(path, steps, ahead, list); }, deposits_->volume);
    return true;
}

bool DepositVisitor::arrive(PathState& path, auto& steps, const Ahead& ahead, const Flight& flight) {
    const bool collided = flight.event == Flight::Event::Collision;
    if (trail_) trail_->arrive(path, ahead, flight);
    if (collided)
        connectable_ = true;
    else
        endChain(path, path.interactions - 1);
    // Guided paths look for themselves what can still be in time from there.
    const bool looks = Guided<std::decay_t<decltype(steps)>> && collided;
    if (!looks && !culling_->mayContinue(path.ray.origin, path.time)) return false;
    if (collided && context_->storeVolume)
        std::visit([&](auto& list) { depositAtVertex(path, steps, flight, *ahead.medium, list); }, deposits_->volume);
    return true;
}

bool DepositVisitor::vertex(PathState& path, auto& steps, const WalkVertex& at) {
    if (at.surface) depositOnSurface(path, at);
    // Without a flight that may leave here nothing else does.
    const bool sends =
        at.surface ? (at.surface->bsdf->lobes() & lobe::Smooth) != 0 : path.flights < at.medium->maxBounces;
    if (connections_ && sends)
        connectToSurfaces(path, gateOf(steps), at.connectible(scene(), TransportMode::Photons),
                          at.surface ? 2.0f * InSphere : InSphere);
    return true;
}

void DepositVisitor::leave(PathState& path, auto&, const WalkVertex& at, const Way& way) {
    if (trail_) trail_->leave(way);
    if (at.medium || way.straight()) return;
    connectable_ = way.smooth() && way.region.medium == path.region.medium && way.region.speed == path.region.speed;
}

// ---- Emission

void DepositVisitor::startAt(PathState& path, const Emitter& emitter) const {
    path.time = emitter.emissionTime + culling_->delays().sample(emitter, path.random);
}

bool DepositVisitor::emitFrom(PathState& path, const Emitter& emitter, float probability,
                              const Vec2f& uPosition) const {
    const EmissionSample emission = sampleEmission(emitter, uPosition, path.random.next2D());
    path.throughput = emission.power / probability;
    startAt(path, emitter);
    path.region = scene().regionOf(emitter);
    path.ray = emission.ray;
    return !isBlack(path.throughput) && culling_->mayContinue(path.ray.origin, path.time);
}

bool DepositVisitor::emit(PathState& path, PlainPhotonSteps& steps) {
    if (guidance_) return emitBySteps(path, steps, 1.0f);
    const auto chosen = context_->emitters.sample(path.random.next1D());
    const Emitter& emitter = scene().emitters[chosen.index];
    const Vec2f uPosition = path.random.next2D();
    withSlices([&](SliceList&) { chain_.beginAt(scene(), emitter, chosen.probability, uPosition); });
    return emitFrom(path, emitter, chosen.probability, uPosition);
}

bool DepositVisitor::emit(PathState& path, StepsToCamera& steps) {
    return emitBySteps(path, steps, guidance_->choosesFrames() ? float(guidance_->frames().frames) : 1.0f);
}

bool DepositVisitor::emitBySteps(PathState& path, auto& steps, float frames) {
    const auto chosen = context_->emitters.sample(path.random.next1D());
    const Emitter& emitter = scene().emitters[chosen.index];
    if (emitter.isDelta() || emitter.isInfinite()) {
        path.random.at(0, Draw::Emission);
        if (!emitFrom(path, emitter, chosen.probability, path.random.next2D())) return false;
        path.throughput = path.throughput * frames;
        return true;
    }
    startAt(path, emitter);
    path.region = scene().regionOf(emitter);
    path.throughput = Rgb(frames / chosen.probability);
    return emitFromPoint(path, steps, emitter, chosen.probability);
}

bool DepositVisitor::emitFromPoint(PathState& path, auto& steps, const Emitter& emitter, float probability) {
    path.random.at(0, Draw::Emission);
    const Vec2f uPosition = path.random.next2D();
    const SurfaceSample start = sampleEmissionPoint(emitter, uPosition);
    path.ray = Ray{start.position, Vec3f(0.0f)};
    connectable_ = true;
    if (!context_->recordCounts)
        withSlices([&](SliceList&) { chain_.beginAt(scene(), emitter, probability, uPosition); });
    if (!culling_->mayContinue(path.ray.origin, path.time)) return false;
    connectToSurfaces(path, gateOf(steps), {scene(), emitter, start}, InSphere * meanComponent(emitterPower(emitter)),
                      true);
    if (context_->storeVolume && context_->recordCounts && guidance_->guide(path.region) && mayGoOn(path))
        withSlices([&](SliceList& slices) {
            Sampler own = records(path, path.interactions, RecordsOf::Light);
            chain_.recordLight(chainRules(), emitter, probability, start,
                               {start.position, Vec3f(0.0f), path.throughput, path.time, Infinity, path.interactions},
                               path.region.medium, own, slices);
            noteVolume({});
        });
    if constexpr (Guided<std::decay_t<decltype(steps)>>) {
        const auto way = steps.emit(path, emitter, start);
        if (!way) return false;
        path.ray = way->ray;
        path.throughput = path.throughput * way->weight;
    } else {
        path.random.at(0, Draw::EmissionDirection);
        const float u = path.random.next1D(), v = path.random.next1D();
        const EmissionDirections own(emitter, start);
        const darts::Vec3 direction = own.sample(u, v);
        if (trail_) trail_->emit(path, emitter, start, darts::to<Vec3f>(direction));
        path.ray = start.spawnRay(darts::to<Vec3f>(direction));
        path.throughput =
            path.throughput * emittedIntensity(emitter, start, path.ray.direction) * (1.0f / own.pdf(direction));
    }
    return !isBlack(path.throughput);
}

// ---- Surfaces

bool DepositVisitor::bears(const Rgb& power) {
    if (isFinite(power)) return !isBlack(power);
    ++counters_->nonFinite;
    return false;
}

void DepositVisitor::depositOnSurface(const PathState& path, const WalkVertex& at) {
    depositOnSurface(path, *at.surface);
    if (!context_->storeVolume) return;
    withSlices([&](SliceList& slices) {
        Sampler own = records(path, path.interactions, RecordsOf::Surface);
        const Weighed weighed = weightAtVertex(path);
        const Rgb power = path.throughput * weighed.weight;
        chain_.recordSurface(chainRules(), *at.surface,
                             {at.position, at.before, power, path.time, Infinity, path.interactions}, path.region, own,
                             slices);
        noteVolume(weighed);
    });
}

void DepositVisitor::depositOnSurface(const PathState& path, const SurfaceInteraction& surface) {
    if (!context_->storeSurface || (surface.bsdf->lobes() & lobe::Smooth) == 0) return;
    const Vec3f& direction = path.ray.direction;
    const float shading = std::abs(direction.dot(surface.frame.n)), geometric = std::abs(direction.dot(surface.hit.ng));
    if (!(geometric > 0.0f)) return;
    if (!culling_->mayCount(surface.hit.position, path.time)) return;
    const auto deposit = [&](const Rgb& power, const Weighed& weighed) {
        deposits_->surface.records.push_back(
            {path.time, surface.hit.position, direction, power * weighed.weight, uint16_t(path.interactions), -1});
        if (deposits_->weighed) deposits_->weighed->surface.push_back(weighed);
    };
    const bool connected = context_->connects && connectable_ && receivesConnections(*surface.bsdf);
    if (connected && context_->densityPhotons) deposit(Rgb(0.0f), {});
    if (connected || foundByCameraSubpaths(path, surface)) return;
    const Rgb arriving = path.throughput * (shading / geometric);
    if (bears(arriving)) deposit(arriving, weightAtVertex(path));
}

bool DepositVisitor::foundByCameraSubpaths(const PathState& path, const SurfaceInteraction& surface) const {
    // But for light that nothing has scattered, by way of mirrors or refraction.
    return context_->glossyCameraSubpaths && isGlossyOnly(*surface.bsdf) && (path.scattered || connectable_);
}

void DepositVisitor::connectToSurfaces(const PathState& path, const darts::TimeGate& gate, const Vertex& vertex,
                                       float meanScattering, bool light) {
    if (!connections_ || !bears(path.throughput) || !connections_->mayArrive(path.time, gate)) return;
    const Weighed weighed = light ? Weighed{} : weightAtVertex(path);
    const ConnectingVertex from{
        {vertex, path.throughput * weighed.weight}, path.time, path.interactions, meanScattering};
    if (connections_->knowsLightPerConnection()) {
        Sampler own = path.random.branch(RandomStream::Connection, uint64_t(path.interactions));
        const uint64_t before = counters_->rays;
        connections_->connect(from, gate, own, draws_, deposits_->received, counters_->rays);
        counters_->connectionRays += counters_->rays - before;
        if (deposits_->weighed) deposits_->weighed->received.resize(deposits_->received.size(), weighed);
    } else {
        deposits_->expectedLight.push_back(connections_->expectedLight(from, gate));
    }
}

// ---- Points

void DepositVisitor::depositOnFlight(PathState& path, auto& steps, const Ahead& ahead, PointList& points) {
    if constexpr (Guided<std::decay_t<decltype(steps)>>) {
        if (!steps.guidance().drawsControlVertices() || !orderCounts(path, 1)) return;
        const bool shares = steps.guidance().storesPhotons();
        const auto met = steps.controlVertex(path, ahead, shares && !weighs());
        if (!met) return;
        const darts::ControlVertex& vertex = met->vertex;
        ++counters_->controlVertices;
        const Medium& medium = *ahead.medium;
        const Rgb power = path.throughput * medium.sigmaS() * medium.transmittance(vertex.distance) * vertex.inversePdf;
        const Vec3f position = path.ray.at(vertex.distance);
        const double time = path.timeAfter(transport::distanceBetween(path.ray.origin, position));
        // In its frame but for rounding, which goes both ways: a test of the frame would only lose what it moves.
        store(context_->culling,
              {time, position, path.ray.direction, power, uint16_t(path.interactions + 1), int16_t(path.region.medium)},
              points, [&]() -> Weighed {
                  if (!weighs())
                      return {shares ? transport::balance(1.0f / vertex.inversePdf, pdfPhoton(medium, vertex.distance))
                                     : 1.0f};
                  const auto ending = steps.inMedium(vertex.distance);
                  return {ending.shareOfControl() * weigh(ending.logRatio).weight, ending.logRatio,
                          transport::Found::Aside};
              });
    }
}

void DepositVisitor::depositAtVertex(PathState& path, auto& steps, const Flight& flight, const Medium& medium,
                                     PointList& points) {
    if (!orderCounts(path)) return;
    if constexpr (Guided<std::decay_t<decltype(steps)>>)
        if (steps.guidance().drawsControlVertices() && !steps.guidance().storesPhotons()) return;
    const auto weight = [&]() -> Weighed {
        if constexpr (Guided<std::decay_t<decltype(steps)>>) {
            if (weighs()) {
                const auto ending = steps.inMedium(flight.distance);
                return {(1.0f - ending.shareOfControl()) * weigh(ending.logRatio).weight, ending.logRatio};
            }
            // Ordinary photons share with control vertices where camera subpaths can fold.
            if (!steps.guidance().drawsControlVertices()) return {};
            return {1.0f - transport::balance(steps.controlVertexPdf(flight.distance).value_or(0.0f),
                                              pdfPhoton(medium, flight.distance))};
        } else {
            return trail_ ? weigh(trail_->inMedium()) : Weighed{};
        }
    };
    store(*culling_,
          {path.time, path.ray.origin, path.ray.direction, path.throughput, uint16_t(path.interactions),
           int16_t(path.region.medium)},
          points, weight);
}

template <typename Weight>
void DepositVisitor::store(const ArrivalCulling& culling, Photon photon, PointList& points, Weight&& weight) {
    if (!bears(photon.power)) return;
    if (guidance_ && guidance_->directView() &&
        !guidance_->view().sees(photon.position, context_->settings.volumeReach()))
        return;
    ++counters_->volumeDeposits;
    if (!culling.mayCount(photon.position, photon.time)) return;
    const Weighed weighed = weight();
    photon.power = photon.power * weighed.weight;
    if (isBlack(photon.power)) return;
    ++counters_->countingDeposits;
    points.records.push_back(photon);
    noteVolume(weighed);
}

// ---- Beams

void DepositVisitor::depositOnFlight(PathState& path, auto&, const Ahead& ahead, BeamList& beams) {
    if (!bears(path.throughput) || !orderCounts(path, 1)) return;
    const Ray& ray = path.ray;
    float start = 0.0f, end = ahead.reach();
    if (guidance_ && guidance_->directView()) {
        // Only what the camera's image shows: the store's room is for what can count.
        const FlightPart seen = guidance_->view().seenPart(ray.origin, ray.direction, context_->settings.volumeReach());
        start = float(seen.start);
        end = std::min(end, float(seen.end));
        if (!(start < end)) return;
    }
    const auto beam = clippedBeam(*culling_, *ahead.medium,
                                  {path.time, ray.origin, ray.direction, path.throughput, start, end,
                                   uint16_t(path.interactions), int16_t(path.region.medium)});
    if (!beam) return;
    const Weighed weighed = weightOnFlight(path);
    beams.records.push_back(*beam);
    beams.records.back().power = path.throughput * weighed.weight;
    noteVolume(weighed);
}

// ---- Slices

SliceBuilder::Rules DepositVisitor::chainRules() const {
    return {scene(), *culling_, std::get<Slices>(context_->settings.primitive).classes, context_->recordCounts};
}

void DepositVisitor::depositOnFlight(PathState& path, auto&, const Ahead& ahead, SliceList& slices) {
    Sampler own = records(path, path.interactions, RecordsOf::Flight);
    const Weighed weighed = weightOnFlight(path);
    const Rgb power = path.throughput * weighed.weight;
    chain_.fly(chainRules(), {path.ray.origin, path.ray.direction, power, path.time, ahead.reach(), path.interactions},
               path.region.medium, own, slices);
    noteVolume(weighed);
}

void DepositVisitor::depositAtVertex(PathState& path, auto&, const Flight&, const Medium&, SliceList& slices) {
    Sampler own = records(path, path.interactions, RecordsOf::Vertex);
    const Weighed weighed = weightThere(path);
    const Rgb power = path.throughput * weighed.weight;
    chain_.scatter(chainRules(), {path.ray.origin, path.ray.direction, power, path.time, Infinity, path.interactions},
                   own, slices);
    noteVolume(weighed);
}

void DepositVisitor::endChain(const PathState& path, int interactions) {
    if (context_->recordCounts) return chain_.end(); // records have drawn their own directions
    withSlices([&](SliceList& slices) {
        Sampler own = records(path, interactions, RecordsOf::End);
        chain_.end(chainRules(), own, slices);
    });
}

// ---- Light paths

void tracePlainPhotons(const PhotonContext& context, const Sampler& sampler, Deposits& deposits,
                       PhotonCounters& counters) {
    transport::Walk walk{PathState{.random = sampler}, PlainPhotonSteps({context.scene, counters, context.watch}),
                         DepositVisitor(context, context.culling, nullptr, nullptr, nullptr, deposits, counters)};
    if (walk.visitor.emit(walk.path, walk.steps)) walk.run();
}

void tracePlainBesideGuided(const PhotonContext& context, const PhotonGuidance& guidance,
                            const SurfaceConnections* connections, const Sampler& sampler, PhotonTrail& trail,
                            Deposits& deposits, PhotonCounters& counters, PhotonCounters& densities) {
    const bool weighs = context.balance.both();
    if (weighs)
        trail.start(
            StepsToCamera({context.scene, densities, context.watch}, guidance, rulesOf(context), guidance.gate()),
            densities.densities);
    ++counters.paths;
    ++counters.plainPaths;
    transport::Walk walk{PathState{.random = sampler}, PlainPhotonSteps({context.scene, counters, context.watch}),
                         DepositVisitor(context, context.culling, &guidance, connections, weighs ? &trail : nullptr,
                                        deposits, counters)};
    if (walk.visitor.emit(walk.path, walk.steps)) walk.run();
}

void traceGuidedPhotons(const PhotonContext& context, const PhotonGuidance& guidance,
                        const SurfaceConnections* connections, const Sampler& sampler, uint64_t path,
                        Deposits& deposits, PhotonCounters& counters) {
    ++counters.paths;
    darts::TimeGate gate = guidance.gate();
    const ArrivalCulling* culling = &context.culling;
    if (guidance.choosesFrames()) {
        const int frame = guidance.frames().stratified(path, context.frameShift);
        gate = guidance.frames().frame(frame);
        culling = &context.frameCullings[size_t(frame)];
    }
    transport::Walk walk{PathState{.random = sampler},
                         StepsToCamera({context.scene, counters, context.watch}, guidance, rulesOf(context), gate),
                         DepositVisitor(context, *culling, &guidance, connections, nullptr, deposits, counters)};
    if (walk.visitor.emit(walk.path, walk.steps)) walk.run();
}

} // namespace tungsten::photon
