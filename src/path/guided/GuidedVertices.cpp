// The walk's vertices: directions drawn for the connections that follow.

#include "path/guided/GuidedPathWalk.h"

namespace tungsten::path {

namespace {

/// A surface whose lobes are all smooth and reflect. Directions into it stand for absorption: their density is 0.
struct SurfaceScatterer {
    const SurfaceInteraction& surface;
    Sampler& sampler; ///< chooses among lobes

    [[nodiscard]] darts::Vec3 sample(float u, float v) const {
        const BsdfRandom random{{u, v}, sampler.next1D()};
        const auto sample = surface.bsdf->sample(surface.query(TransportMode::Radiance), surface.wi, random);
        return darts::vec3(sample ? surface.frame.toWorld(sample->wo).normalized() : -surface.frame.n);
    }
    [[nodiscard]] float pdf(const darts::Vec3& direction) const {
        return surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi,
                                 surface.frame.toLocal(darts::to<Vec3f>(direction)));
    }
};

} // namespace

darts::ConnectionSample GuidedPathWalk::drawConnection(const darts::Guide& guide, const darts::Residual& residual) {
    return guide.sampleConnection(residual, next(),
                                  {context_.sensor.response.get(), time_ + target_->start, double(region_.speed)});
}

double GuidedPathWalk::arrivalOf(const darts::ConnectionSample& connection) const {
    const double length = residual_.shortest + double(connection.excess - residual_.low);
    return time_ + length / double(region_.speed) + target_->start;
}

template <typename Scatterer>
darts::DirectionSample GuidedPathWalk::sampleDirection(const darts::Guide& guide, const Scatterer& scatterer) {
    const bool lengthFirst = guide.settings().lengthFirst;
    const darts::ConnectionSample connection =
        lengthFirst ? drawConnection(guide, residual_) : darts::ConnectionSample{};
    const darts::DirectionSample sample =
        guide.sampleDirection(residual_, connection, scatterer, darts::NoView{}, [this] { return next(); });
    if (lengthFirst && elliptical(guide)) {
        connectionDrawn_ = true;
        if (sharesConnections()) drawn_ = {&guide, residual_, sample.h, 0.0f};
        const auto vertex = guide.controlVertex(residual_, connection, sample.h, Infinity);
        if (vertex) pending_ = Pending{*vertex, arrivalOf(connection)};
    }
    return sample;
}

template <typename GoOn>
void GuidedPathWalk::split(const darts::Guide& guide, GoOn&& goOn) {
    const int copies = splits_.copies(guide.splits(reachable_));
    throughput_ = throughput_ / float(copies);
    for (int i = 1; i < copies; ++i) {
        GuidedPathWalk copy(*this);
        goOn(copy);
        sampler_ = copy.sampler_;
    }
}

bool GuidedPathWalk::scatterInMedium(const Medium& medium, float distance) {
    ++counters_.mediumEvents;
    time_ = timeAfter(distance);
    ++interactions_;
    ++mediumScatters_;
    scattered_ = true;
    last_ = Last::Medium;
    const Vec3f before = ray_.direction;
    const float controlShare = elliptical(guideOf(region_)) ? shareOfControlVertex(medium, distance) : 0.0f;
    ray_ = Ray{ray_.at(distance), before};
    arrivalPdf_ = reflectedTried_ ? scatteringPdf_ * context_.lightPaths.flights().pdf(distance) / sqr(distance) : 0.0f;
    arrivalNormal_ = Vec3f(0.0f);
    reflectedTried_ = false;
    lookAhead(ray_.origin);
    if (!reachable_.alive()) return false;
    lookOut({ray_.origin});
    connectFromMedium(medium, controlShare);
    const darts::Guide& guide = guideOf(region_);
    if (interactions_ + 1 >= scene_.transport.maxBounces || !roulette(guide)) return false;
    split(guide, [&](GuidedPathWalk& copy) {
        if (copy.leaveInMedium(medium, before)) copy.goOn();
    });
    return leaveInMedium(medium, before);
}

bool GuidedPathWalk::leaveInMedium(const Medium& medium, const Vec3f& before) {
    const darts::Guide& guide = guideOf(region_);
    forgetConnection();
    connectToLightPaths(nullptr);
    if (!residual_.alive() || guide.settings().direction == darts::Direction::Phase) {
        ray_.direction = medium.phase.sample(before, sampler_.next2D());
        scatteringPdf_ = medium.phase.pdf(before, ray_.direction);
        return true;
    }
    const darts::DirectionSample sample = sampleDirection(guide, darts::PhaseScatterer{medium.phase, before});
    ray_.direction = darts::to<Vec3f>(sample.direction);
    scatteringPdf_ = medium.phase.eval(before, ray_.direction);
    throughput_ = throughput_ * (scatteringPdf_ * sample.inversePdf);
    return !isBlack(throughput_);
}

bool GuidedPathWalk::scatterOnSurface(const SurfaceHit& hit) {
    ++counters_.surfaceEvents;
    time_ = timeAfter(hit.t);
    flights_ = 0;
    if (timed()) {
        lookAhead(hit.position);
        if (!reachable_.alive()) return false;
    }
    if (++interactions_ >= scene_.transport.maxBounces) return false;
    // The format ends such a path at any surface, index-matched ones included.
    if (context_.settings.limits.endsAtSurface(mediumScatters_)) return false;
    lightVertexTried_ = false;
    const SurfaceInteraction surface = makeInteraction(scene_, hit, ray_.direction);
    const darts::Guide* guide = guideFor(surface, -ray_.direction);
    const float cosine = ray_.direction.dot(hit.ng);
    arrivalPdf_ = reflectedTried_ && guide ? scatteringPdf_ * std::abs(cosine) / sqr(hit.t) : 0.0f;
    arrivalNormal_ = cosine < 0.0f ? hit.ng : -hit.ng;
    reflectedTried_ = false;
    return guide ? leaveGuided(surface, *guide) : leavePlainly(surface);
}

/// The guide of the medium before a surface all of whose lobes are smooth and reflect; none elsewhere. `back` is the
/// way there, turned round.
const darts::Guide* GuidedPathWalk::guideFor(const SurfaceInteraction& surface, const Vec3f& back) const {
    if (!endsReflectedLight(*surface.bsdf)) return nullptr;
    const Region region = regionBeyond(surface, back, region_);
    const Medium* medium = scene_.medium(region);
    if (!medium || !medium->scatters()) return nullptr;
    const bool diffuse = (surface.bsdf->lobes() & lobe::DiffuseReflection) != 0;
    const auto& guides = diffuse ? context_.guides.surfaces : context_.guides.glossy;
    const darts::Guide& guide = guides[size_t(region.medium)];
    return guide.settings().direction == darts::Direction::Phase ? nullptr : &guide;
}

bool GuidedPathWalk::leaveGuided(const SurfaceInteraction& surface, const darts::Guide& guide) {
    scattered_ = true;
    region_ = regionBeyond(surface, -ray_.direction, region_);
    lookAhead(surface.hit.position);
    last_ = Last::Surface;
    vertex_ = surface.hit.position;
    ray_ = Ray{vertex_, ray_.direction};
    if (residual_.alive()) {
        lookOut({vertex_, surface.hit.margin()});
        if (!roulette(guide)) return false;
    }
    connectToLightPaths(&surface);
    if (!residual_.alive()) return leavePlainly(surface);
    forgetConnection();
    const darts::DirectionSample sample = sampleDirection(guide, SurfaceScatterer{surface, sampler_});
    ray_ = surface.hit.leave(darts::to<Vec3f>(sample.direction));
    const Scattering scattering = scatteringTowards(ray_.direction, &surface);
    throughput_ = throughput_ * scattering.value * sample.inversePdf;
    scatteringPdf_ = scattering.pdf;
    return !isBlack(throughput_);
}

bool GuidedPathWalk::leavePlainly(const SurfaceInteraction& surface) {
    const auto exit =
        sampleExit(surface, surface.query(TransportMode::Radiance), scene_.transport.consistencyChecks, sampler_);
    if (!exit) return false;
    throughput_ = throughput_ * exit->weight;
    if (isBlack(throughput_)) return false;
    if ((exit->lobe & lobe::Smooth) != 0) {
        scattered_ = true;
        last_ = Last::Surface;
        scatteringPdf_ = exit->pdf;
        vertex_ = surface.hit.position;
    } else if (!exit->straight()) {
        last_ = Last::Specular;
    }
    passBoundary(surface, exit->direction, exit->straight());
    ray_ = surface.hit.leave(exit->direction);
    if (timed()) lookAhead(ray_.origin);
    return true;
}

/// Into the region ahead. A connection drawn before goes on through a boundary that light passes straight at its speed.
void GuidedPathWalk::passBoundary(const SurfaceInteraction& surface, const Vec3f& direction, bool straight) {
    const float speed = region_.speed;
    region_ = regionBeyond(surface, direction, region_);
    if (!straight || region_.speed != speed)
        forgetConnection();
    else if (pending_)
        pending_->vertex.distance -= surface.hit.t;
    drawn_.behind += surface.hit.t;
}

} // namespace tungsten::path
