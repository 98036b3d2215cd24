#include "path/GuidedPath.h"

#include "path/techniques/ReflectedLight.h"

namespace tungsten::path {

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
    return guide.sampleConnection(
        residual, next(), {context.sensor.response.get(), state.time + target->start, double(state.region.speed)});
}

} // namespace tungsten::path
