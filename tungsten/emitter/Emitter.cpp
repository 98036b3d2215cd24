#include "tungsten/emitter/Emitter.h"

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/Power.h"
#include "tungsten/emitter/Sampling.h"

namespace tungsten {

const AreaEmitter* Emitter::surface() const {
    using Answer = const AreaEmitter*;
    return std::visit(Overloaded{[](const AreaEmitter& area) { return Answer(&area); },
                                 [](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter,
                                                InfiniteSphereEmitter> auto&) { return Answer(nullptr); }},
                      model);
}

std::optional<uint32_t> Emitter::primitive() const {
    const AreaEmitter* area = surface();
    return area ? std::optional(area->primitive) : std::nullopt;
}

bool Emitter::isConnectable() const {
    return std::visit(Overloaded{[](const OneOf<PointEmitter, SpotEmitter, AreaEmitter> auto&) { return true; },
                                 [](const OneOf<DirectionalPointEmitter, CollimatedEmitter> auto&) { return false; },
                                 [](const InfiniteSphereEmitter& sky) { return sky.samplable; }},
                      model);
}

EmissionSample sampleEmission(const Emitter& emitter, const Vec2f& uPosition, const Vec2f& uDirection) {
    return std::visit([&](const auto& model) { return sampleEmission(model, uPosition, uDirection); }, emitter.model);
}

SurfaceSample sampleEmissionPoint(const Emitter& emitter, const Vec2f& u) {
    return std::visit(Overloaded{[&](const AreaEmitter& area) { return area.samplePoint(u); },
                                 [&](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter,
                                                 InfiniteSphereEmitter> auto& other) {
                                     const EmissionSample sample = sampleEmission(other, u, Vec2f(0.5f, 0.5f));
                                     return SurfaceSample{sample.ray.origin, sample.normal, {0.0f, 0.0f}};
                                 }},
                      emitter.model);
}

Rgb emittedIntensity(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction) {
    const float cosine = direction.dot(start.normal);
    return std::visit(
        Overloaded{[&](const PointEmitter& point) { return point.intensity; },
                   [&](const SpotEmitter& spot) { return spot.intensity * spot.falloffTowards(direction); },
                   [&](const AreaEmitter& area) {
                       if (!area.shinesAt(cosine)) return Rgb(0.0f);
                       return area.radiance.rgb(start.uv) * (cosine * area.areaSampler->area());
                   },
                   [](const OneOf<DirectionalPointEmitter, CollimatedEmitter> auto&) { return Rgb(0.0f); },
                   // An environment has no starting point common to all directions.
                   [](const InfiniteSphereEmitter&) { return Rgb(0.0f); }},
        emitter.model);
}

EmissionCone emissionCone(const Emitter& emitter, const SurfaceSample& start) {
    return std::visit(Overloaded{[](const OneOf<PointEmitter, InfiniteSphereEmitter> auto&) { return EmissionCone{}; },
                                 [](const SpotEmitter& spot) {
                                     return EmissionCone{spot.direction, 1.0f - spot.cosOuter, false};
                                 },
                                 [&](const AreaEmitter& area) {
                                     return EmissionCone{start.normal, 1.0f - area.cosCone(), true};
                                 },
                                 [](const DirectionalPointEmitter& laser) {
                                     return EmissionCone{laser.direction, 0.0f, false};
                                 },
                                 [](const CollimatedEmitter& laser) {
                                     return EmissionCone{laser.frame.n, 0.0f, false};
                                 }},
                      emitter.model);
}

float pdfEmissionDirection(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction) {
    return std::visit(
        Overloaded{[](const PointEmitter&) { return warp::squareToSpherePdf(); },
                   [&](const SpotEmitter& spot) {
                       return direction.dot(spot.direction) >= spot.cosOuter ? warp::squareToConePdf(spot.cosOuter)
                                                                             : 0.0f;
                   },
                   [&](const AreaEmitter& area) {
                       return warp::squareToCosineConePdf({0.0f, 0.0f, direction.dot(start.normal)}, area.cosCone());
                   },
                   [](const OneOf<DirectionalPointEmitter, CollimatedEmitter> auto&) { return 0.0f; },
                   [&](const InfiniteSphereEmitter& sky) { return pdfSky(sky, -direction); }},
        emitter.model);
}

float emittingArea(const Emitter& emitter) {
    return std::visit(Overloaded{[](const AreaEmitter& area) { return area.areaSampler->area(); },
                                 [](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter,
                                                InfiniteSphereEmitter> auto&) { return 0.0f; }},
                      emitter.model);
}

BoundingSphere boundingSphere(const Emitter& emitter) {
    return std::visit(Overloaded{[](const OneOf<PointEmitter, SpotEmitter, DirectionalPointEmitter> auto& point) {
                                     return BoundingSphere{point.position, 0.0f};
                                 },
                                 [](const CollimatedEmitter& laser) {
                                     return BoundingSphere{laser.position, laser.radius};
                                 },
                                 [](const AreaEmitter& area) { return boundingSphere(*area.shape); },
                                 [](const InfiniteSphereEmitter& sky) {
                                     return BoundingSphere{sky.sceneCentre, Infinity};
                                 }},
                      emitter.model);
}

std::optional<DirectSample> sampleDirect(const Emitter& emitter, const Vec3f& receiver, const Vec2f& u) {
    using Answer = std::optional<DirectSample>;
    return std::visit(
        Overloaded{[&](const OneOf<PointEmitter, SpotEmitter, AreaEmitter, InfiniteSphereEmitter> auto& model) {
                       return sampleDirect(model, receiver, u);
                   },
                   [](const OneOf<DirectionalPointEmitter, CollimatedEmitter> auto&) { return Answer(); }},
        emitter.model);
}

float pdfDirect(const Emitter& emitter, const Vec3f& receiver, const Vec3f& position, const Vec3f& ng) {
    return std::visit(Overloaded{[&](const AreaEmitter& area) {
                                     const Vec3f offset = position - receiver;
                                     const float squared = offset.length2();
                                     const float cosine = -offset.dot(ng) / std::sqrt(squared);
                                     return cosine > 0.0f ? squared / (cosine * area.areaSampler->area()) : 0.0f;
                                 },
                                 [](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter,
                                                InfiniteSphereEmitter> auto&) { return 0.0f; }},
                      emitter.model);
}

std::optional<Rgb> isotropicIntensity(const Emitter& emitter) {
    using Answer = std::optional<Rgb>;
    return std::visit(Overloaded{[](const PointEmitter& point) { return Answer(point.intensity); },
                                 [](const OneOf<DirectionalPointEmitter, CollimatedEmitter, SpotEmitter, AreaEmitter,
                                                InfiniteSphereEmitter> auto&) { return Answer(); }},
                      emitter.model);
}

Rgb emittedRadiance(const Emitter& emitter, const Vec2f& uv, const Vec3f& ng, const Vec3f& towards) {
    return std::visit(Overloaded{[&](const AreaEmitter& area) {
                                     return area.shinesAt(ng.dot(towards)) ? area.radiance.rgb(uv) : Rgb(0.0f);
                                 },
                                 [](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter,
                                                InfiniteSphereEmitter> auto&) { return Rgb(0.0f); }},
                      emitter.model);
}

float pdfDirectInfinite(const Emitter& emitter, const Vec3f& direction) {
    return std::visit(
        Overloaded{
            [&](const InfiniteSphereEmitter& sky) { return sky.samplable ? pdfSky(sky, direction) : 0.0f; },
            [](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter, AreaEmitter> auto&) {
                return 0.0f;
            }},
        emitter.model);
}

Rgb environmentRadiance(const Emitter& emitter, const Vec3f& direction) {
    return std::visit(
        Overloaded{
            [&](const InfiniteSphereEmitter& sky) { return skyRadiance(sky, direction); },
            [](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter, AreaEmitter> auto&) {
                return Rgb(0.0f);
            }},
        emitter.model);
}

void encloseScene(Emitter& emitter, const Vec3f& centre, float radius) {
    std::visit(
        Overloaded{
            [&](InfiniteSphereEmitter& sky) {
                sky.sceneCentre = centre;
                sky.sceneRadius = radius;
            },
            [](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter, AreaEmitter> auto&) {
            }},
        emitter.model);
}

Rgb emitterPower(const Emitter& emitter) {
    return std::visit(
        Overloaded{
            [](const PointEmitter& point) { return point.intensity * (4.0f * Pi); },
            [](const SpotEmitter& spot) { return spot.intensity * spotSolidAngle(spot.cosInner, spot.cosOuter); },
            [](const OneOf<DirectionalPointEmitter, CollimatedEmitter> auto& laser) { return laser.power; },
            [](const AreaEmitter& area) { return area.radiance.average() * area.extent(); },
            [](const InfiniteSphereEmitter& sky) {
                return sky.radiance.average() * (4.0f * Pi * Pi * sqr(sky.sceneRadius));
            }},
        emitter.model);
}

} // namespace tungsten
