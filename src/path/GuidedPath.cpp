#include "path/GuidedPath.h"

#include "path/techniques/Connection.h"
#include "path/techniques/ReflectedLight.h"

namespace tungsten::path {

Straight GuidedPath::straightFrom(const Vec3f& position) const {
    const Vec3f offset = target->point.position - position;
    const float distance = offset.length();
    return {distance > 0.0f ? offset / distance : Vec3f(0.0f, 0.0f, 1.0f), distance};
}

Ray GuidedPath::toTarget(Ray ray, const Straight& way) const {
    ray.tMax = target->point.margin().before(way.direction, way.distance);
    return ray;
}

Visibility GuidedPath::traceToTarget(const Ray& ray, const Straight& way, const Region& region) {
    return traceConnection(scene(), context.forwardBoundaries, toTarget(ray, way), way.distance, region,
                           state.counters.shadowRays);
}

Ray GuidedPath::leave(const SurfaceInteraction* surface, const Vec3f& direction, float reach) const {
    Ray ray = surface ? surface->hit.leave(direction) : Ray{state.ray.origin, direction};
    ray.tMax = reach;
    return ray;
}

Scattering GuidedPath::scatteringTowards(const Vec3f& direction, const SurfaceInteraction* surface) const {
    if (!surface) {
        const float phase = scene().medium(state.region)->phase.eval(state.ray.direction, direction);
        return {Rgb(phase), phase};
    }
    if (!surface->consistent(direction, scene().transport.consistencyChecks)) return {};
    const Vec3f wo = surface->frame.toLocal(direction);
    const BsdfQuery query = surface->query(TransportMode::Radiance);
    return {surface->bsdf->eval(query, surface->wi, wo), surface->bsdf->pdf(query, surface->wi, wo)};
}

LengthsInGate GuidedPath::lengthsInGate() const {
    const TimeGate& gate = context.sensor.gate;
    const double speed = double(state.region.speed), elapsed = state.time + target->start;
    return {float(speed * (gate.start - elapsed)), float(speed * (gate.end() - elapsed))};
}

bool GuidedPath::counts(int interactions, int mediumScatters) const {
    const int total = state.interactions + interactions + target->interactions;
    if (total < scene().transport.minBounces || total >= scene().transport.maxBounces) return false;
    const int inMedia = state.mediumScatters + mediumScatters + target->mediumScatters;
    if (inMedia == 0) return context.settings.includeSurfaces;
    return context.settings.lowOrderScattering || inMedia > 1;
}

const darts::Guide* GuidedPath::guideFor(const SurfaceInteraction& surface, const Vec3f& back) const {
    if (!endsReflectedLight(*surface.bsdf)) return nullptr;
    const Region region = regionBeyond(surface, back, state.region);
    const Medium* medium = scene().medium(region);
    if (!medium || !medium->scatters()) return nullptr;
    const bool diffuse = (surface.bsdf->lobes() & lobe::DiffuseReflection) != 0;
    const auto& guides = diffuse ? context.guides.surfaces : context.guides.glossy;
    const darts::Guide& guide = guides[size_t(region.medium)];
    return guide.settings().direction == darts::Direction::Phase ? nullptr : &guide;
}

darts::ConnectionSample GuidedPath::drawConnection(const darts::Guide& guide, const darts::Residual& residual) {
    return guide.sampleConnection(residual, next(),
                                  {context.sensor.response, state.time + target->start, double(state.region.speed)});
}

} // namespace tungsten::path
