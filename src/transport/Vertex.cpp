#include "transport/Vertex.h"

#include "tungsten/core/Overloaded.h"

namespace tungsten::transport {

Vec3f Vertex::position() const {
    return std::visit(Overloaded{[](const LightPoint& light) { return light.point.position; },
                                 [](const SurfacePoint& at) { return at.surface.hit.position; },
                                 [](const MediumPoint& at) { return at.position; }},
                      point_);
}

SurfaceMargin Vertex::margin() const {
    return std::visit(Overloaded{[](const LightPoint& light) { return light.point.margin(); },
                                 [](const SurfacePoint& at) { return at.surface.hit.margin(); },
                                 [](const MediumPoint&) { return SurfaceMargin{}; }},
                      point_);
}

bool Vertex::isConnectible() const {
    return std::visit(
        Overloaded{[](const LightPoint& light) { return !light.emitter->isDelta() && !light.emitter->isInfinite(); },
                   [](const SurfacePoint& at) { return (at.surface.bsdf->lobes() & lobe::Smooth) != 0; },
                   [](const MediumPoint&) { return true; }},
        point_);
}

Rgb Vertex::scattering(const Vec3f& direction) const {
    return std::visit(
        Overloaded{[&](const LightPoint& light) { return emittedIntensity(*light.emitter, light.point, direction); },
                   [&](const SurfacePoint& at) -> Rgb {
                       const SurfaceInteraction& surface = at.surface;
                       if (!surface.consistent(direction, at.consistencyChecks)) return Rgb(0.0f);
                       const Rgb value = surface.bsdf->eval(surface.query(at.mode, lobe::Smooth), surface.wi,
                                                            surface.frame.toLocal(direction));
                       if (at.mode == TransportMode::Radiance) return value;
                       return value * surface.photonShadingFactor(-at.before, direction);
                   },
                   [&](const MediumPoint& at) { return Rgb(at.medium->phase.eval(at.before, direction)); }},
        point_);
}

float Vertex::pdf(const Vec3f& direction) const {
    return std::visit(Overloaded{[](const LightPoint&) { return 0.0f; },
                                 [&](const SurfacePoint& at) {
                                     return at.surface.bsdf->pdf(at.surface.query(at.mode), at.surface.wi,
                                                                 at.surface.frame.toLocal(direction));
                                 },
                                 [&](const MediumPoint& at) { return at.medium->phase.pdf(at.before, direction); }},
                      point_);
}

float Vertex::areaDensity(float pdfSolidAngle, const Vec3f& direction, float distance) const {
    const float perArea = pdfSolidAngle / sqr(distance);
    return std::visit(
        Overloaded{[&](const LightPoint& light) {
                       return emittingArea(*light.emitter) > 0.0f
                                  ? perArea * std::abs(direction.dot(light.point.normal))
                                  : perArea;
                   },
                   [&](const SurfacePoint& at) { return perArea * std::abs(direction.dot(at.surface.hit.ng)); },
                   [&](const MediumPoint&) { return perArea; }},
        point_);
}

Ray Vertex::leave(const Vec3f& direction) const {
    return {position(), direction, margin().beyond(direction)};
}

Region Vertex::regionTowards(const Vec3f& direction) const {
    return std::visit(Overloaded{[&](const LightPoint&) { return region_; },
                                 [&](const SurfacePoint& at) { return regionBeyond(at.surface, direction, region_); },
                                 [&](const MediumPoint&) { return region_; }},
                      point_);
}

} // namespace tungsten::transport
