#include "tungsten/emitter/Emitter.h"

#include "tungsten/emitter/Power.h"
#include "tungsten/emitter/Sampling.h"

namespace tungsten {

bool Emitter::isDelta() const {
    return std::holds_alternative<DirectionalPointEmitter>(model) || std::holds_alternative<CollimatedEmitter>(model);
}

bool Emitter::isPointLike() const {
    if (const auto* beam = std::get_if<CollimatedEmitter>(&model)) return beam->radius == 0.0f;
    return !isArea() && !isInfinite();
}

EmissionSample sampleEmission(const Emitter& emitter, const Vec2f& uPosition, const Vec2f& uDirection) {
    return std::visit([&](const auto& model) { return sampleEmission(model, uPosition, uDirection); }, emitter.model);
}

SurfaceSample sampleEmissionPoint(const Emitter& emitter, const Vec2f& u) {
    if (const auto* area = std::get_if<AreaEmitter>(&emitter.model)) return area->areaSampler->sample(*area->shape, u);
    const EmissionSample sample = sampleEmission(emitter, u, Vec2f(0.5f, 0.5f));
    return {sample.ray.origin, sample.normal, {0.0f, 0.0f}};
}

Rgb emittedIntensity(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction) {
    if (const auto* point = std::get_if<PointEmitter>(&emitter.model)) return point->intensity;
    if (const auto* spot = std::get_if<SpotEmitter>(&emitter.model))
        return spot->intensity * spot->falloffTowards(direction);
    const float cosine = direction.dot(start.normal);
    if (const auto* area = std::get_if<AreaEmitter>(&emitter.model); area && area->shinesAt(cosine))
        return area->radiance.rgb(start.uv) * (cosine * area->areaSampler->area());
    return Rgb(0.0f);
}

std::optional<DirectSample> sampleDirect(const Emitter& emitter, const Vec3f& receiver, const Vec2f& u) {
    return std::visit(
        [&](const auto& model) -> std::optional<DirectSample> {
            using Model = std::decay_t<decltype(model)>;
            constexpr bool SingleDirection =
                std::is_same_v<Model, DirectionalPointEmitter> || std::is_same_v<Model, CollimatedEmitter>;
            if constexpr (SingleDirection)
                return std::nullopt;
            else
                return sampleDirect(model, receiver, u);
        },
        emitter.model);
}

float pdfDirect(const Emitter& emitter, const Vec3f& receiver, const Vec3f& position, const Vec3f& ng) {
    const auto* area = std::get_if<AreaEmitter>(&emitter.model);
    if (!area) return 0.0f;
    const Vec3f offset = position - receiver;
    const float squared = offset.length2();
    const float cosine = -offset.dot(ng) / std::sqrt(squared);
    return cosine > 0.0f ? squared / (cosine * area->areaSampler->area()) : 0.0f;
}

Rgb emittedRadiance(const Emitter& emitter, const Vec2f& uv, const Vec3f& ng, const Vec3f& towards) {
    const auto* area = std::get_if<AreaEmitter>(&emitter.model);
    return area && area->shinesAt(ng.dot(towards)) ? area->radiance.rgb(uv) : Rgb(0.0f);
}

Rgb emitterPower(const Emitter& emitter) {
    if (const auto* point = std::get_if<PointEmitter>(&emitter.model)) return point->intensity * (4.0f * Pi);
    if (const auto* spot = std::get_if<SpotEmitter>(&emitter.model))
        return spot->intensity * spotSolidAngle(spot->cosInner, spot->cosOuter);
    if (const auto* beam = std::get_if<DirectionalPointEmitter>(&emitter.model)) return beam->power;
    if (const auto* beam = std::get_if<CollimatedEmitter>(&emitter.model)) return beam->power;
    if (const auto* area = std::get_if<AreaEmitter>(&emitter.model)) return area->radiance.average() * area->extent();
    const auto& sky = std::get<InfiniteSphereEmitter>(emitter.model);
    return sky.radiance.average() * (4.0f * Pi * Pi * sqr(sky.sceneRadius));
}

} // namespace tungsten
