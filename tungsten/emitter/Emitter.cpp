#include "tungsten/emitter/Emitter.h"

#include "tungsten/emitter/EmitterReader.h"

namespace tungsten {

EmissionSample sampleEmission(const Emitter& emitter, const Vec2f& uPosition, const Vec2f& uDirection) {
    return std::visit([&](const auto& m) { return m.sampleEmission(uPosition, uDirection); }, emitter.model);
}

SurfaceSample sampleEmissionPoint(const Emitter& emitter, const Vec2f& u) {
    if (const AreaEmitter* area = emitter.surface()) return area->samplePoint(u);
    const EmissionSample sample = sampleEmission(emitter, u, Vec2f(0.5f, 0.5f));
    return {sample.ray.origin, sample.normal, {0.0f, 0.0f}};
}

Rgb emittedIntensity(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction) {
    return std::visit([&](const auto& m) { return m.emittedIntensity(start, direction); }, emitter.model);
}

EmissionCone emissionCone(const Emitter& emitter, const SurfaceSample& start) {
    return std::visit([&](const auto& m) { return m.emissionCone(start); }, emitter.model);
}

float pdfEmissionDirection(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction) {
    return std::visit([&](const auto& m) { return m.pdfEmissionDirection(start, direction); }, emitter.model);
}

std::optional<Rgb> isotropicIntensity(const Emitter& emitter) {
    return std::visit([](const auto& m) { return m.isotropicIntensity(); }, emitter.model);
}

float emittingArea(const Emitter& emitter) {
    const AreaEmitter* area = emitter.surface();
    return area ? area->areaSampler->area() : 0.0f;
}

BoundingSphere boundingSphere(const Emitter& emitter) {
    return std::visit([](const auto& m) { return m.boundingSphere(); }, emitter.model);
}

std::optional<DirectSample> sampleDirect(const Emitter& emitter, const Vec3f& receiver, const Vec2f& u) {
    return std::visit([&](const auto& m) { return m.sampleDirect(receiver, u); }, emitter.model);
}

float pdfDirect(const Emitter& emitter, const Vec3f& receiver, const Vec3f& position, const Vec3f& ng) {
    const AreaEmitter* area = emitter.surface();
    return area ? area->pdfDirect(receiver, position, ng) : 0.0f;
}

Rgb emittedRadiance(const Emitter& emitter, const Vec2f& uv, const Vec3f& ng, const Vec3f& towards) {
    const AreaEmitter* area = emitter.surface();
    return area ? area->emittedRadiance(uv, ng, towards) : Rgb(0.0f);
}

float pdfDirectInfinite(const Emitter& emitter, const Vec3f& direction) {
    return std::visit([&](const auto& m) { return m.pdfDirectInfinite(direction); }, emitter.model);
}

Rgb environmentRadiance(const Emitter& emitter, const Vec3f& direction) {
    return std::visit([&](const auto& m) { return m.environmentRadiance(direction); }, emitter.model);
}

void encloseScene(Emitter& emitter, const Vec3f& centre, float radius) {
    std::visit([&](auto& m) { m.encloseScene(centre, radius); }, emitter.model);
}

Rgb emitterPower(const Emitter& emitter) {
    return std::visit([](const auto& m) { return m.totalPower(); }, emitter.model);
}

EmitterReader::Strength EmitterReader::strength(const Meaning& emissionMeaning, const Meaning& powerMeaning) const {
    const Rgb emission = constantTexture("emission", emissionMeaning);
    const Rgb power = constantTexture("power", powerMeaning);
    return has("power") ? Strength{power, true} : Strength{emission, false};
}

} // namespace tungsten
