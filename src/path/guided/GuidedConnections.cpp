// The ways in which a guided walk finds light: control vertices, ordinary connections, light vertices, emitters met.

#include "path/guided/GuidedPathWalk.h"
#include "path/guided/ShellChord.h"
#include "path/techniques/Connection.h"

namespace tungsten::path {

GuidedPathWalk::Straight GuidedPathWalk::straightFrom(const Vec3f& position) const {
    const Vec3f offset = target_->point.position - position;
    const float distance = offset.length();
    return {distance > 0.0f ? offset / distance : Vec3f(0.0f, 0.0f, 1.0f), distance};
}

Ray GuidedPathWalk::toTarget(Ray ray, const Straight& way) const {
    ray.tMax = target_->point.margin().before(way.direction, way.distance);
    return ray;
}

void GuidedPathWalk::connectElliptically(const Medium& medium, const darts::Guide& guide, float h, float surface) {
    if (!elliptical(guide)) return;
    if (connectionDrawn_) {
        if (!pending_ || !(pending_->vertex.distance < surface)) return;
        if (pending_->vertex.distance >= 0.0f) addControlVertex(medium, pending_->vertex, pending_->arrival);
        pending_.reset();
        return;
    }
    drawn_.guide = nullptr;
    if (!residual_.alive()) return;
    const darts::Residual before = darts::Guide::beforeSurface(residual_, h, surface);
    if (!before.alive()) return;
    const darts::ConnectionSample connection = drawConnection(guide, before);
    if (sharesConnections()) drawn_ = {&guide, before, h, 0.0f};
    const auto vertex = guide.controlVertex(residual_, connection, h, surface);
    if (vertex) addControlVertex(medium, *vertex, arrivalOf(connection));
}

void GuidedPathWalk::connectUntimed(const Medium& medium, float surface) {
    if (!elliptical(guideOf(region_))) return;
    const TimeGate& gate = context_.sensor.gate;
    const double speed = double(region_.speed), low = speed * (gate.start - target_->start),
                 high = speed * (gate.end() - target_->start);
    const ShellChord chord(target_->point.position - ray_.origin, ray_.direction, low, high, double(surface));
    const auto add = [&](double t, double inversePdf) {
        const double toTarget = double((target_->point.position - ray_.at(float(t))).length());
        addControlVertex(medium, {float(t), float(toTarget), float(inversePdf)}, toTarget / speed + target_->start);
    };
    if (gate.delta) {
        std::array<double, 2> t{}, perRadius{};
        const int count = chord.intersect(low, t, perRadius);
        for (size_t i = 0; i < size_t(count); ++i) add(t[i], perRadius[i]);
    } else if (!chord.empty()) {
        const double t = chord.sample(sampler_.nextDouble()), pdf = chord.pdf(t);
        if (pdf > 0.0) add(t, 1.0 / pdf);
    }
}

/// The last vertex before the target, in the medium of the present segment.
void GuidedPathWalk::addControlVertex(const Medium& medium, const darts::ControlVertex& vertex, double arrival) {
    if (!context_.forwardBoundaries && !counts(1, 1)) return;
    const Vec3f position = ray_.at(vertex.distance);
    const Straight way = straightFrom(position);
    if (!(vertex.toTarget > 0.0f) || !(way.distance > 0.0f)) return;
    ++counters_.controlVertices;
    const Rgb light = target_->intensity(-way.direction);
    if (isBlack(light)) return;
    const float phase = medium.phase.eval(ray_.direction, way.direction);
    const float chance = guideOf(region_).chance(residual_, darts::vec3(ray_.direction), vertex, phase);
    if (chance < 1.0f && !(next() < chance)) return;
    const Visibility visibility =
        traceConnection(scene_, context_.forwardBoundaries, toTarget({position, way.direction}, way), way.distance,
                        region_, counters_.shadowRays);
    if (isBlack(visibility.transmittance) || !visibility.oneSpeed || !counts(1 + visibility.crossings, 1)) return;
    const float share = shareOfControlVertex(medium, vertex.distance);
    const float weight = phase / sqr(vertex.toTarget) * vertex.inversePdf * share / chance;
    const Rgb radiance = throughput_ * medium.sigmaS() * medium.transmittance(vertex.distance) * light *
                         visibility.transmittance * weight;
    // A delta gate is one of time, the connection's weight dt/dS one of length.
    sink_.addInside(context_.sensor.gate.delta ? radiance * region_.speed : radiance, arrival);
}

float GuidedPathWalk::shareOfControlVertex(const Medium& medium, float distance) const {
    if (!drawn_.guide) return 1.0f;
    const float pdf = drawn_.guide->pdfControlVertex(drawn_.residual, drawn_.h, drawn_.behind + distance);
    const float sigmaT = meanComponent(medium.sigmaT());
    return pdf / (pdf + sigmaT * std::exp(-sigmaT * distance));
}

void GuidedPathWalk::connectFromMedium(const Medium& medium, float controlShare) {
    if (residual_.exit.sealed) return;
    if (controlShare == 1.0f && context_.arrival.oneSpeed()) return; // control vertices find it
    const Straight way = straightFrom(ray_.origin);
    ++counters_.connections;
    if (!mayConnect(time_, way.distance)) return;
    const Rgb light = target_->intensity(-way.direction);
    if (isBlack(light)) return;
    const Visibility visibility =
        traceConnection(scene_, context_.forwardBoundaries, toTarget({ray_.origin, way.direction}, way), way.distance,
                        region_, counters_.shadowRays);
    if (isBlack(visibility.transmittance) || !counts(visibility.crossings, 0)) return;
    const float share = visibility.oneSpeed ? 1.0f - controlShare : 1.0f;
    if (!(share > 0.0f)) return;
    const float phase = medium.phase.eval(ray_.direction, way.direction);
    sink_.add(throughput_ * light * visibility.transmittance * (phase / sqr(way.distance) * share),
              time_ + visibility.time + target_->start);
}

GuidedPathWalk::Scattering GuidedPathWalk::scatteringTowards(const Vec3f& direction,
                                                             const SurfaceInteraction* surface) const {
    if (!surface) {
        const float phase = scene_.medium(region_)->phase.eval(ray_.direction, direction);
        return {Rgb(phase), phase};
    }
    if (!surface->consistent(direction, scene_.transport.consistencyChecks)) return {};
    const Vec3f wo = surface->frame.toLocal(direction);
    const BsdfQuery query = surface->query(TransportMode::Radiance);
    return {surface->bsdf->eval(query, surface->wi, wo), surface->bsdf->pdf(query, surface->wi, wo)};
}

Ray GuidedPathWalk::leave(const SurfaceInteraction* surface, const Vec3f& direction, float reach) const {
    Ray ray = surface ? surface->hit.leave(direction) : Ray{ray_.origin, direction};
    ray.tMax = reach;
    return ray;
}

void GuidedPathWalk::connectToLightPaths(const SurfaceInteraction* surface) {
    const Medium* medium = scene_.medium(region_);
    lightVertexTried_ = context_.lightPaths.vertices(target_->index) && mayFly(medium);
    if (!lightVertexTried_) return;
    connectToLightVertex(surface);
    // Wherever reflected light ends, light vertices would be tried.
    reflectedTried_ = context_.lightPaths.reflected(target_->index) && medium && flights_ + 1 < medium->maxBounces;
    if (reflectedTried_) connectToReflectedLight(surface);
}

void GuidedPathWalk::connectToLightVertex(const SurfaceInteraction* surface) {
    if (!counts(1, 0)) return;
    const Medium* medium = scene_.medium(region_);
    const LightVertexCache* cache = context_.lightPaths.vertices(target_->index);
    const TimeGate& gate = context_.sensor.gate;
    const double speed = double(region_.speed), elapsed = time_ + target_->start;
    const float low = float(speed * (gate.start - elapsed)), high = float(speed * (gate.end() - elapsed));
    const LightVertexCache::Choice choice = cache->choose(ray_.origin, low, high, sampler_.next2D());
    if (!choice.vertex) return;
    const LightVertex& vertex = *choice.vertex;
    const Vec3f offset = vertex.surface.hit.position - ray_.origin;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return;
    const Vec3f direction = offset / distance;
    const Ray ray = leave(surface, direction, vertex.surface.hit.margin().before(direction, distance));
    if (!(ray.tMin < ray.tMax)) return;
    const Scattering scattering = scatteringTowards(direction, surface);
    const Rgb onward = vertex.scattered(-direction);
    if (isBlack(scattering.value) || isBlack(onward)) return;
    ++counters_.shadowRays;
    ++counters_.lightVertices;
    if (scene_.geometry->occluded(ray)) return;
    const float perArea = std::abs(direction.dot(vertex.surface.hit.ng)) / sqr(distance);
    const float tried = triedDensity(vertex.areaPdf), walk = scattering.pdf * perArea;
    const float share =
        tried / (tried + walk + reflectedDensity(vertex.surface, -direction, distance, vertex.toLight, vertex.areaPdf));
    const Medium* beyond = scene_.medium(regionBeyond(vertex.surface, vertex.toLight, region_));
    Rgb transmittance = medium ? medium->transmittance(distance) : Rgb(1.0f);
    if (beyond) transmittance = transmittance * beyond->transmittance(vertex.distance);
    sink_.add(throughput_ * scattering.value * transmittance * onward * (perArea * choice.weight * share),
              elapsed + (double(distance) + double(vertex.distance)) / speed);
}

float GuidedPathWalk::reflectedDensity(const SurfaceInteraction& glossy, const Vec3f& direction, float flight,
                                       const Vec3f& toLight, float areaPdf) const {
    if (!(arrivalPdf_ > 0.0f) || !reflectsSharply(*glossy.bsdf)) return 0.0f;
    const bool inMedium = isBlack(arrivalNormal_);
    const float cosine = -direction.dot(arrivalNormal_);
    if (!inMedium && !(cosine > 0.0f)) return 0.0f;
    const float pdf = glossy.bsdf->pdf(glossy.query(TransportMode::Radiance), glossy.frame.toLocal(toLight),
                                       glossy.frame.toLocal(direction));
    const float end = inMedium ? context_.lightPaths.flights().pdf(flight) : cosine;
    return context_.lightPaths.reflected(target_->index)->tried() * areaPdf * pdf * end / sqr(flight) / arrivalPdf_;
}

void GuidedPathWalk::connectToReflectedLight(const SurfaceInteraction* surface) {
    const Medium* medium = scene_.medium(region_);
    const ReflectedLightCache* cache = context_.lightPaths.reflected(target_->index);
    const TimeGate& gate = context_.sensor.gate;
    const double speed = double(region_.speed), elapsed = time_ + target_->start;
    const float low = float(speed * (gate.start - elapsed)), high = float(speed * (gate.end() - elapsed));
    const ReflectedLightCache::Choice choice = cache->choose(ray_.origin, low, high, sampler_.next2D());
    if (!choice.vertex) return;
    const ReflectedVertex& vertex = *choice.vertex;
    if (!counts(2, vertex.surface ? 0 : 1)) return;
    const Vec3f offset = vertex.position - ray_.origin;
    const float distance = offset.length();
    if (!(distance > 0.0f)) return;
    const Vec3f direction = offset / distance;
    const Ray ray =
        leave(surface, direction, vertex.surface ? vertex.surface->hit.margin().before(direction, distance) : distance);
    if (!(ray.tMin < ray.tMax)) return;

    // The reflected light's end as a walk would meet it: what it scatters here, and in which medium its light came.
    Scattering end;
    float arrival = 1.0f / sqr(distance); // of scattering here towards it, per area or volume
    Region region = region_;
    if (vertex.surface) {
        const SurfaceInteraction& there = *vertex.surface;
        if (!mayBeLightVertex(there, -direction, vertex.toGlossy) || !guideFor(there, -direction) ||
            !there.consistent(-direction, scene_.transport.consistencyChecks))
            return;
        const Vec3f wi = there.frame.toLocal(-direction), wo = there.frame.toLocal(vertex.toGlossy);
        const BsdfQuery query = there.query(TransportMode::Radiance);
        end = {there.bsdf->eval(query, wi, wo), there.bsdf->pdf(query, wi, wo)};
        arrival *= std::abs(direction.dot(there.hit.ng));
        region = regionBeyond(there, -direction, region_);
    } else {
        const float phase = medium->phase.eval(direction, vertex.toGlossy);
        end = {medium->sigmaS() * phase, phase};
    }
    const Scattering scattering = scatteringTowards(direction, surface);
    if (isBlack(scattering.value) || isBlack(end.value)) return;
    ++counters_.shadowRays;
    ++counters_.reflectedLight;
    if (scene_.geometry->occluded(ray)) return;
    const float flight = vertex.surface ? 1.0f : context_.lightPaths.flights().pdf(distance);
    const float walk =
        scattering.pdf * arrival * flight * (end.pdf * vertex.walkGeometry + triedDensity(vertex.glossy.areaPdf));
    const float tried = cache->tried() * vertex.density;
    Rgb transmittance = medium->transmittance(distance);
    if (const Medium* between = scene_.medium(region))
        transmittance = transmittance * between->transmittance(vertex.flight);
    if (const Medium* beyond = scene_.medium(regionBeyond(vertex.glossy.surface, vertex.glossy.toLight, region)))
        transmittance = transmittance * beyond->transmittance(vertex.glossy.distance);
    sink_.add(throughput_ * scattering.value * end.value * transmittance * vertex.power *
                  (arrival * choice.weight * (tried / (tried + walk))),
              elapsed + (double(distance) + double(vertex.length)) / speed);
}

void GuidedPathWalk::findAt(const SurfaceHit& hit, const Rgb& throughput) {
    if (isBlack(throughput)) return;
    if (target_->index >= 0 && scene_.primitives[hit.shape].emitter == target_->index) addEmission(hit, throughput);
    if ((scene_.bsdfOf(hit).lobes() & lobe::Smooth) == 0) return;
    const Straight way = straightFrom(hit.position);
    ++counters_.connections;
    if (!mayConnect(timeAfter(hit.t), way.distance)) return;
    connectFromSurface(makeInteraction(scene_, hit, ray_.direction), way, throughput);
}

float GuidedPathWalk::shareOfWalk(const SurfaceInteraction& surface, const Straight& way) const {
    const Vec3f& ng = surface.hit.ng;
    if (!lightVertexTried_ || !mayBeLightVertex(surface, -ray_.direction, way.direction)) return 1.0f;
    const float lightCosine = std::abs(way.direction.dot(ng)), cosine = std::abs(ray_.direction.dot(ng));
    const float areaPdf =
        pdfEmissionDirection(*target_->emitter, target_->point, -way.direction) * lightCosine / sqr(way.distance);
    const float walk = scatteringPdf_ * cosine / sqr(surface.hit.t);
    return walk / (walk + triedDensity(areaPdf) +
                   reflectedDensity(surface, -ray_.direction, surface.hit.t, way.direction, areaPdf));
}

void GuidedPathWalk::connectFromSurface(const SurfaceInteraction& surface, const Straight& way, const Rgb& throughput) {
    if (!surface.consistent(way.direction, scene_.transport.consistencyChecks)) return;
    const Vec3f wo = surface.frame.toLocal(way.direction);
    const Rgb scattering = surface.bsdf->eval(surface.query(TransportMode::Radiance, lobe::Smooth), surface.wi, wo);
    if (isBlack(scattering)) return;
    const Rgb light = target_->intensity(-way.direction);
    if (isBlack(light)) return;
    const Region region = regionBeyond(surface, way.direction, region_);
    const Visibility visibility =
        traceConnection(scene_, context_.forwardBoundaries, toTarget(surface.hit.leave(way.direction), way),
                        way.distance, region, counters_.shadowRays);
    if (isBlack(visibility.transmittance) || !counts(1 + visibility.crossings, 0)) return;
    // Weights by the surface's own density, which, unlike the guided one, is a function of the path alone.
    const float lightPdf = target_->pdfFrom(surface.hit.position, target_->point.position, target_->point.normal);
    const float bsdfPdf = surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi, wo);
    float weight = lightPdf > 0.0f ? powerHeuristic(lightPdf, bsdfPdf) : 1.0f;
    if (visibility.crossings == 0) weight *= shareOfWalk(surface, way);
    sink_.add(throughput * scattering * light * visibility.transmittance * (weight / sqr(way.distance)),
              timeAfter(surface.hit.t) + visibility.time + target_->start);
}

void GuidedPathWalk::addEmission(const SurfaceHit& hit, const Rgb& throughput) {
    if (last_ == Last::Medium || !counts(0, 0)) return; // connections from media find it
    const Rgb radiance = emittedRadiance(*target_->emitter, hit.uv, hit.ng, -ray_.direction);
    if (isBlack(radiance)) return;
    float weight = 1.0f;
    if (last_ == Last::Surface)
        weight = powerHeuristic(scatteringPdf_, target_->pdfFrom(vertex_, hit.position, hit.ng));
    sink_.add(throughput * radiance * (weight / target_->probability), timeAfter(hit.t) + target_->start);
}

} // namespace tungsten::path
