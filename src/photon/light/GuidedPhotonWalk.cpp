#include "photon/light/GuidedPhotonWalk.h"

#include "photon/light/EmissionDirections.h"

namespace tungsten::photon {

namespace {

/// Of light that goes everywhere evenly, per solid angle.
constexpr float InSphere = 0.25f * InvPi;

} // namespace

GuidedPhotonWalk::GuidedPhotonWalk(const WalkContext& context, const PhotonGuidance& guidance,
                                   const SurfaceConnections* connections, const Sampler& sampler, uint64_t path,
                                   Deposits& deposits, WalkCounters& counters)
    : path_(context, sampler, deposits, counters), scene_(context.scene), guidance_(guidance),
      connections_(connections), gate_(guidance.gate()) {
    if (guidance.choosesFrames()) aimAtFrame(path);
}

void GuidedPhotonWalk::aimAtFrame(uint64_t path) {
    const int frame = guidance_.frames().stratified(path, path_.context.frameShift);
    gate_ = guidance_.frames().frame(frame);
    path_.culling = &path_.context.frameCullings[size_t(frame)];
}

void GuidedPhotonWalk::run() {
    if (emit()) goOn();
}

void GuidedPhotonWalk::goOn() {
    while (path_.mayBounce()) {
        path_.counters.step(path_.context.watch);
        const darts::Guide* guide = guidance_.guide(path_.region);
        if (guide) {
            if (!crossMedium(*scene_.medium(path_.region), *guide)) return;
            continue;
        }
        ++path_.counters.rays;
        const auto hit = scene_.geometry->intersect(path_.ray);
        if (!hit) return;
        if (const Medium* medium = scene_.medium(path_.region)) {
            path_.counters.fly(*medium);
            path_.power = path_.power * medium->transmittance(hit->t);
        }
        step_.leave();
        if (!meetSurface(*hit)) return;
    }
}

bool GuidedPhotonWalk::emit() {
    const auto chosen = path_.context.emitters.sample(path_.sampler.next1D());
    const Emitter& emitter = scene_.emitters[chosen.index];
    const float frames = guidance_.choosesFrames() ? float(guidance_.frames().frames) : 1.0f;
    if (emitter.isDelta() || emitter.isInfinite()) {
        path_.sampler.at(0, Draw::Emission);
        if (!path_.emitFrom(emitter, chosen.probability, path_.sampler.next2D())) return false;
        path_.power = path_.power * frames;
        return true;
    }
    path_.startAt(emitter);
    path_.region = scene_.regionOf(emitter);
    path_.power = Rgb(frames / chosen.probability);
    const darts::Guide* guide = guidance_.guide(path_.region);
    return emitFromPoint(emitter, chosen.probability, guide && guide->settings().guideEmission ? guide : nullptr);
}

bool GuidedPhotonWalk::emitFromPoint(const Emitter& emitter, float probability, const darts::Guide* guide) {
    path_.sampler.at(0, Draw::Emission);
    const SurfaceSample start = sampleEmissionPoint(emitter, path_.sampler.next2D());
    path_.ray = Ray{start.position, Vec3f(0.0f)};
    path_.connectable = true;
    if (!path_.culling->mayContinue(path_.ray.origin, path_.time)) return false;
    connectToSurfaces({scene_, emitter, start}, InSphere * meanComponent(emitterPower(emitter)));
    if (path_.context.storeVolume && guidance_.guide(path_.region) && path_.mayBounce())
        std::visit([&](auto& list) { leaveLight(list, emitter, probability, start); }, path_.deposits.volume);
    // What is guided aims at the camera itself.
    const EmissionDirections own(emitter, start, guide ? std::span<const transport::BodySphere>() : guidance_.bodies());
    float inversePdf = 0.0f;
    if (guide) {
        if (!look(*guide, {start.position, start.margin()})) return false;
        inversePdf = redirect(*guide, own);
    } else {
        path_.sampler.at(0, Draw::Direction);
        const float u = path_.sampler.next1D(), v = path_.sampler.next1D();
        const darts::Vec3 direction = own.sample(u, v);
        path_.ray.direction = darts::to<Vec3f>(direction);
        inversePdf = 1.0f / own.pdf(direction);
    }
    path_.ray = start.leave(path_.ray.direction);
    path_.power = path_.power * emittedIntensity(emitter, start, path_.ray.direction) * inversePdf;
    return !isBlack(path_.power);
}

void GuidedPhotonWalk::connectToSurfaces(const transport::Vertex& vertex, float meanScattering) {
    if (!connections_ || !path_.bears(path_.power)) return;
    const SendingVertex from{{vertex, path_.power}, path_.time, path_.bounce, meanScattering};
    if (connections_->knowsLightPerConnection()) {
        Sampler own = path_.sampler.branch(RandomStream::Connection, uint64_t(path_.bounce));
        connections_->connect(from, gate_, own, draws_, path_.deposits.received, path_.counters.rays);
    } else {
        path_.deposits.expectedLight.push_back(connections_->expectedLight(from, gate_));
    }
}

bool GuidedPhotonWalk::meetSurface(const SurfaceHit& hit) {
    chain_.end();
    if (!path_.arriveOnSurface(hit)) return false;
    path_.leaveOnSurface(chain_, hit.position);
    if (connections_ && (path_.surface.bsdf->lobes() & lobe::Smooth) != 0)
        connectToSurfaces({scene_, path_.surface, path_.ray.direction, TransportMode::Photons, path_.region},
                          2.0f * InSphere);
    return path_.leaveSurface();
}

bool GuidedPhotonWalk::look(const darts::Guide& guide, const transport::Start& start) {
    step_.look(guidance_.residual(start, path_.region, path_.time, gate_, path_.counters.rays));
    // Along a direction that is fixed the surface ahead bounds the lengths: they are drawn when it is known.
    if (!guide.settings().lengthFirst || start.ahead.length2() > 0.0f) return step_.residual().alive();
    path_.sampler.at(path_.bounce, Draw::Connection);
    const darts::ConnectionSample connection = drawConnection(guide, step_.residual());
    step_.connect(connection);
    // A density of 0: the response is over, or the delta gate, but surfaces may still be seen in its kernel.
    return step_.residual().alive() && (connection.inversePdf > 0.0f || guidance_.meetsDeltaGate());
}

darts::ConnectionSample GuidedPhotonWalk::drawConnection(const darts::Guide& guide, const darts::Residual& residual) {
    if (guidance_.meetsDeltaGate() && storesVertices()) return guidance_.onDeltaGate(residual);
    return guide.sampleConnection(residual, path_.sampler.next1D(), guidance_.response(path_.time));
}

template <typename Scatterer>
float GuidedPhotonWalk::redirect(const darts::Guide& guide, const Scatterer& scatterer) {
    path_.sampler.at(path_.bounce, Draw::GuidedDirection);
    const auto random = [this] { return path_.sampler.next1D(); };
    const darts::DirectionSample next = step_.sampleDirection(guide, scatterer, guidance_.view(), random);
    path_.ray.direction = darts::to<Vec3f>(next.direction);
    return next.inversePdf;
}

bool GuidedPhotonWalk::survives(const darts::Guide& guide) {
    const int medium = path_.region.medium;
    const float power = meanComponent(path_.power);
    const bool out = step_.residual().way == darts::Way::Out;
    if (path_.context.measured && out) {
        path_.context.measured->record(medium, guide.logUsefulness(step_.reachable(), power));
        return false;
    }
    const float others =
        out && path_.context.first ? path_.context.first->logged(medium) : transport::GuidedSteps::NoOthers;
    const float survival = step_.survival(guide, medium, power, others);
    if (survival >= 1.0f) return true;
    path_.sampler.at(path_.bounce, Draw::Roulette);
    if (path_.sampler.next1D() >= survival) return false;
    path_.power = path_.power / survival;
    return true;
}

bool GuidedPhotonWalk::crossMedium(const Medium& medium, const darts::Guide& guide) {
    if (++path_.flights > medium.maxBounces) return false;
    const bool afterSurface = !step_.hasLooked();
    if (afterSurface && (!look(guide, transport::Start::along(path_.ray)) || !survives(guide))) return false;
    const darts::Heading heading = step_.heading(path_.ray.direction);
    path_.ray.tMax = step_.bound(guide, heading.h);
    ++path_.counters.rays;
    const auto hit = scene_.geometry->intersect(path_.ray);
    path_.ray.tMax = Infinity;
    const float surface = hit ? hit->t : Infinity;
    if (hit && step_.residual().way == darts::Way::Out && step_.residual().exit.connects)
        step_.leaveWithOdds(guidance_.leaveOdds(path_.region, path_.ray.direction, *hit));
    const Flight flight{medium, guide, heading.h, surface};
    if (path_.context.storeVolume) std::visit([&](auto& list) { leaveOn(flight, list); }, path_.deposits.volume);

    path_.sampler.at(path_.bounce + 1, Draw::Distance);
    const auto random = [this] { return path_.sampler.next1D(); };
    const darts::DistanceSample next = step_.sampleDistance(guide, heading, surface, path_.power, random);
    const Rgb weight = darts::to<Rgb>(next.transmittanceOverPdf);
    path_.power = path_.power * (next.surface ? weight : weight * medium.sigmaS());
    if (isBlack(path_.power)) return false;
    if (next.surface) {
        step_.leave();
        return meetSurface(*hit);
    }
    if (path_.context.storeVolume)
        std::visit([&](auto& list) { leaveAt(next.distance, flight, list); }, path_.deposits.volume);
    step_.leave();
    return scatter(medium, guide, next.distance);
}

bool GuidedPhotonWalk::scatter(const Medium& medium, const darts::Guide& guide, float distance) {
    const Vec3f position = path_.ray.at(distance), before = path_.ray.direction;
    path_.collide(position, path_.distanceTo(position));
    if (!look(guide, {position})) return false;
    if (path_.flights < medium.maxBounces) // else no flight would leave here
        connectToSurfaces({medium, position, before, path_.region}, InSphere);
    if (!survives(guide)) return false;
    split(guide, medium, before);
    return leave(medium, guide, before);
}

bool GuidedPhotonWalk::leave(const Medium& medium, const darts::Guide& guide, const Vec3f& before) {
    const float inversePdf = redirect(guide, darts::PhaseScatterer{medium.phase, before});
    path_.power = path_.power * (medium.phase.eval(before, path_.ray.direction) * inversePdf);
    return !isBlack(path_.power);
}

void GuidedPhotonWalk::split(const darts::Guide& guide, const Medium& medium, const Vec3f& before) {
    const int copies = step_.copies(guide);
    path_.power = path_.power / float(copies);
    for (int i = 1; i < copies; ++i) {
        GuidedPhotonWalk copy(*this);
        copy.path_.sampler = path_.sampler.copy(path_.bounce, i);
        if (guide.settings().lengthFirst) {
            copy.path_.sampler.at(path_.bounce, Draw::Connection);
            copy.step_.connect(copy.drawConnection(guide, copy.step_.residual()));
        }
        if (copy.leave(medium, guide, before)) copy.goOn();
    }
}

} // namespace tungsten::photon
