#include "photon/light/DepositVisitor.h"

#include "photon/Tuning.h"
#include "photon/light/EmissionDirections.h"

#include "transport/Balance.h"

namespace tungsten::photon {

using transport::Ahead;
using transport::Flight;
using transport::Vertex;
using transport::WalkVertex;
using transport::Way;

namespace {

/// Of light that goes everywhere evenly, per solid angle.
constexpr float InSphere = 0.25f * InvPi;

/// Density per length, for weights, of an ordinary photon at this distance along a flight.
float pdfPhoton(const Medium& medium, float distance) {
    return transport::pdfFreeFlight(meanComponent(medium.sigmaT()), distance);
}

/// The part of a photon that is left to control vertices, by densities per length along the flight: the balance
/// heuristic, and all of it where hardly any ordinary photon would get.
float shareOfVertices(float pdfVertex, float pdfPhoton) {
    return pdfPhoton < tuning::LeastPhotons * pdfVertex ? 1.0f : transport::balance(pdfVertex, pdfPhoton);
}

} // namespace

// ---- The walk's hooks

bool DepositVisitor::ahead(PathState& path, auto& steps, const Ahead& ahead) {
    if (context_->storeVolume && ahead.medium && ahead.medium->scatters())
        std::visit([&](auto& list) { leaveOnFlight(path, steps, ahead, list); }, deposits_->volume);
    return true;
}

bool DepositVisitor::arrive(PathState& path, auto& steps, const Ahead& ahead, const Flight& flight) {
    const bool collided = flight.event == Flight::Event::Collision;
    if (collided)
        connectable_ = true;
    else
        endChain(path, path.interactions - 1);
    // Guided paths look for themselves what can still be in time from there.
    const bool looks = Guided<std::decay_t<decltype(steps)>> && collided;
    if (!looks && !culling_->mayContinue(path.ray.origin, path.time)) return false;
    if (collided && context_->storeVolume)
        std::visit([&](auto& list) { leaveAtVertex(path, steps, flight, *ahead.medium, list); }, deposits_->volume);
    return true;
}

bool DepositVisitor::vertex(PathState& path, auto& steps, const WalkVertex& at) {
    if (at.surface) leaveOnSurface(path, at);
    if constexpr (Guided<std::decay_t<decltype(steps)>>) {
        // Without a flight that may leave here nothing else does.
        const bool sends =
            at.surface ? (at.surface->bsdf->lobes() & lobe::Smooth) != 0 : path.flights < at.medium->maxBounces;
        if (connections_ && sends)
            connectToSurfaces(path, steps.gate(), at.connectible(scene(), TransportMode::Photons),
                              at.surface ? 2.0f * InSphere : InSphere);
    }
    return true;
}

void DepositVisitor::leave(PathState& path, auto&, const WalkVertex& at, const Way& way) {
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

bool DepositVisitor::emit(PathState& path, PlainPhotonSteps&) {
    const auto chosen = context_->emitters.sample(path.random.next1D());
    const Emitter& emitter = scene().emitters[chosen.index];
    const Vec2f uPosition = path.random.next2D();
    withSlices([&](SliceList&) { chain_.beginAt(scene(), emitter, chosen.probability, uPosition); });
    return emitFrom(path, emitter, chosen.probability, uPosition);
}

bool DepositVisitor::emit(PathState& path, StepsToCamera& steps) {
    guided_ = true;
    const auto chosen = context_->emitters.sample(path.random.next1D());
    const Emitter& emitter = scene().emitters[chosen.index];
    const PhotonGuidance& guidance = steps.guidance();
    const float frames = guidance.choosesFrames() ? float(guidance.frames().frames) : 1.0f;
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

bool DepositVisitor::emitFromPoint(PathState& path, StepsToCamera& steps, const Emitter& emitter, float probability) {
    path.random.at(0, Draw::Emission);
    const SurfaceSample start = sampleEmissionPoint(emitter, path.random.next2D());
    path.ray = Ray{start.position, Vec3f(0.0f)};
    connectable_ = true;
    if (!culling_->mayContinue(path.ray.origin, path.time)) return false;
    connectToSurfaces(path, steps.gate(), {scene(), emitter, start}, InSphere * meanComponent(emitterPower(emitter)));
    const PhotonGuidance& guidance = steps.guidance();
    const darts::Guide* guide = guidance.guide(path.region);
    if (context_->storeVolume && guide && mayGoOn(path))
        withSlices([&](SliceList& slices) {
            Sampler own = records(path, path.interactions, RecordsOf::Light);
            chain_.leaveLight(chainRules(), emitter, probability, start,
                              {start.position, Vec3f(0.0f), path.throughput, path.time, Infinity, path.interactions},
                              path.region.medium, own, slices);
        });
    const bool guides = guide && guide->settings().guideEmission;
    // What is guided aims at the camera itself.
    const EmissionDirections own(emitter, start, guides ? std::span<const transport::BodySphere>() : guidance.bodies());
    Vec3f direction;
    float inversePdf = 0.0f;
    if (guides) {
        const auto drawn = steps.emit(path, {start.position, start.margin()}, own, direction);
        if (!drawn) return false;
        inversePdf = *drawn;
    } else {
        path.random.at(0, Draw::Direction);
        const float u = path.random.next1D(), v = path.random.next1D();
        const darts::Vec3 sample = own.sample(u, v);
        direction = darts::to<Vec3f>(sample);
        inversePdf = 1.0f / own.pdf(sample);
    }
    path.ray = start.leave(direction);
    path.throughput = path.throughput * emittedIntensity(emitter, start, path.ray.direction) * inversePdf;
    return !isBlack(path.throughput);
}

// ---- Surfaces

bool DepositVisitor::bears(const Rgb& power) {
    if (isFinite(power)) return !isBlack(power);
    ++counters_->nonFinite;
    return false;
}

void DepositVisitor::leaveOnSurface(const PathState& path, const WalkVertex& at) {
    depositOnSurface(path, *at.surface);
    if (!context_->storeVolume) return;
    withSlices([&](SliceList& slices) {
        Sampler own = records(path, path.interactions, RecordsOf::Surface);
        chain_.leaveSurface(chainRules(), *at.surface,
                            {at.position, at.before, path.throughput, path.time, Infinity, path.interactions},
                            path.region, own, slices);
    });
}

void DepositVisitor::depositOnSurface(const PathState& path, const SurfaceInteraction& surface) {
    if (!context_->storeSurface || (surface.bsdf->lobes() & lobe::Smooth) == 0) return;
    const Vec3f& direction = path.ray.direction;
    const float shading = std::abs(direction.dot(surface.frame.n)), geometric = std::abs(direction.dot(surface.hit.ng));
    if (!(geometric > 0.0f)) return;
    const auto deposit = [&](const Rgb& power) {
        if (culling_->mayCount(surface.hit.position, path.time))
            deposits_->surface.records.push_back(
                {path.time, surface.hit.position, direction, power, uint16_t(path.interactions), -1});
    };
    const bool connected = context_->connects && connectable_ && receivesConnections(*surface.bsdf);
    if (connected && context_->densityPhotons) deposit(Rgb(0.0f));
    if (connected || foundBySensorPaths(path, surface)) return;
    const Rgb arriving = path.throughput * (shading / geometric);
    if (bears(arriving)) deposit(arriving);
}

bool DepositVisitor::foundBySensorPaths(const PathState& path, const SurfaceInteraction& surface) const {
    // But for light that nothing has scattered, by way of mirrors or refraction.
    return context_->glossySensorPaths && isGlossyOnly(*surface.bsdf) && (path.scattered || connectable_);
}

void DepositVisitor::connectToSurfaces(const PathState& path, const darts::TimeGate& gate, const Vertex& vertex,
                                       float meanScattering) {
    if (!connections_ || !bears(path.throughput)) return;
    const SendingVertex from{{vertex, path.throughput}, path.time, path.interactions, meanScattering};
    if (connections_->knowsLightPerConnection()) {
        Sampler own = path.random.branch(RandomStream::Connection, uint64_t(path.interactions));
        connections_->connect(from, gate, own, draws_, deposits_->received, counters_->rays);
    } else {
        deposits_->expectedLight.push_back(connections_->expectedLight(from, gate));
    }
}

// ---- Points

void DepositVisitor::leaveOnFlight(PathState& path, auto& steps, const Ahead& ahead, PointList& points) {
    if constexpr (Guided<std::decay_t<decltype(steps)>>) {
        if (!steps.guide().settings().elliptical || !orderCounts(path, 1)) return;
        const bool shares = steps.guidance().storesPhotons();
        const auto met = steps.controlVertex(path, ahead, shares);
        if (!met) return;
        const darts::ControlVertex& vertex = met->vertex;
        ++counters_->controlVertices;
        const Medium& medium = *ahead.medium;
        Rgb power = path.throughput * medium.sigmaS() * medium.transmittance(vertex.distance) * vertex.inversePdf;
        if (shares) power = power * shareOfVertices(1.0f / vertex.inversePdf, pdfPhoton(medium, vertex.distance));
        const Vec3f position = path.ray.at(vertex.distance);
        const double time = path.timeAfter(transport::distanceBetween(path.ray.origin, position));
        // In its frame but for rounding, which goes both ways: a test of the frame would only lose what it moves.
        store(steps, context_->culling,
              {time, position, path.ray.direction, power, uint16_t(path.interactions + 1), int16_t(path.region.medium)},
              points);
    }
}

void DepositVisitor::leaveAtVertex(PathState& path, auto& steps, const Flight& flight, const Medium& medium,
                                   PointList& points) {
    if (!orderCounts(path)) return;
    Rgb power = path.throughput;
    if constexpr (Guided<std::decay_t<decltype(steps)>>) {
        // Ordinary photons share with control vertices where sensor paths can fold.
        const bool elliptical = steps.guide().settings().elliptical;
        if (!steps.guidance().storesPhotons() && elliptical) return;
        float share = 0.0f;
        if (elliptical)
            share = shareOfVertices(steps.controlVertexPdf(flight.distance).value_or(0.0f),
                                    pdfPhoton(medium, flight.distance));
        power = power * (1.0f - share);
    }
    store(steps, *culling_,
          {path.time, path.ray.origin, path.ray.direction, power, uint16_t(path.interactions),
           int16_t(path.region.medium)},
          points);
}

void DepositVisitor::store(const auto& steps, const ArrivalCulling& culling, const Photon& photon, PointList& points) {
    if (!bears(photon.power)) return;
    if constexpr (Guided<std::decay_t<decltype(steps)>>) {
        const PhotonGuidance& guidance = steps.guidance();
        if (guidance.directView() && !guidance.view().sees(photon.position, context_->settings.volumeReach())) return;
    }
    ++counters_->volumeDeposits;
    if (!culling.mayCount(photon.position, photon.time)) return;
    ++counters_->countingDeposits;
    points.records.push_back(photon);
}

// ---- Beams

void DepositVisitor::leaveOnFlight(PathState& path, auto& steps, const Ahead& ahead, BeamList& beams) {
    if (!bears(path.throughput) || !orderCounts(path, 1)) return;
    const Ray& ray = path.ray;
    float start = 0.0f, end = ahead.reach();
    if constexpr (Guided<std::decay_t<decltype(steps)>>) {
        // In direct view only what the camera's image shows: the store's room is for what can count.
        const PhotonGuidance& guidance = steps.guidance();
        if (guidance.directView()) {
            const FlightPart seen =
                guidance.view().seenPart(ray.origin, ray.direction, context_->settings.volumeReach());
            start = float(seen.start);
            end = std::min(end, float(seen.end));
            if (!(start < end)) return;
        }
    }
    storeBeam(beams, *culling_, *ahead.medium,
              {path.time, ray.origin, ray.direction, path.throughput, start, end, uint16_t(path.interactions),
               int16_t(path.region.medium)});
}

// ---- Slices

FlightChain::Rules DepositVisitor::chainRules() const {
    return {scene(), *culling_, std::get<Slices>(context_->settings.primitive).classes, context_->recordCounts};
}

void DepositVisitor::leaveOnFlight(PathState& path, auto&, const Ahead& ahead, SliceList& slices) {
    Sampler own = records(path, path.interactions, RecordsOf::Flight);
    chain_.fly(chainRules(),
               {path.ray.origin, path.ray.direction, path.throughput, path.time, ahead.reach(), path.interactions},
               path.region.medium, own, slices);
}

void DepositVisitor::leaveAtVertex(PathState& path, auto&, const Flight&, const Medium&, SliceList& slices) {
    Sampler own = records(path, path.interactions, RecordsOf::Vertex);
    chain_.scatter(chainRules(),
                   {path.ray.origin, path.ray.direction, path.throughput, path.time, Infinity, path.interactions}, own,
                   slices);
}

void DepositVisitor::endChain(const PathState& path, int interactions) {
    if (guided_) return chain_.end();
    withSlices([&](SliceList& slices) {
        Sampler own = records(path, interactions, RecordsOf::End);
        chain_.end(chainRules(), own, slices);
    });
}

// ---- Light paths

void tracePlainPhotons(const PhotonContext& context, const Sampler& sampler, Deposits& deposits,
                       PhotonCounters& counters) {
    transport::Walk walk{PathState{.random = sampler}, PlainPhotonSteps({context.scene, counters, context.watch}),
                         DepositVisitor(context, context.culling, nullptr, deposits, counters)};
    if (walk.visitor.emit(walk.path, walk.steps)) walk.run();
}

void traceGuidedPhotons(const PhotonContext& context, const PhotonGuidance& guidance,
                        const SurfaceConnections* connections, const Sampler& sampler, uint64_t path,
                        Deposits& deposits, PhotonCounters& counters) {
    darts::TimeGate gate = guidance.gate();
    const ArrivalCulling* culling = &context.culling;
    if (guidance.choosesFrames()) {
        const int frame = guidance.frames().stratified(path, context.frameShift);
        gate = guidance.frames().frame(frame);
        culling = &context.frameCullings[size_t(frame)];
    }
    const bool storesVertices =
        context.storeVolume && std::visit([](const auto& p) { return p.AtVertices; }, context.settings.primitive);
    transport::Walk walk{PathState{.random = sampler},
                         StepsToCamera({context.scene, counters, context.watch}, guidance,
                                       {storesVertices, context.first, context.measured}, gate),
                         DepositVisitor(context, *culling, connections, deposits, counters)};
    if (walk.visitor.emit(walk.path, walk.steps)) walk.run();
}

} // namespace tungsten::photon
