#include "path/LightVertices.h"

#include "path/Connection.h"

#include "tungsten/core/Warp.h"

#include <tbb/parallel_for.h>

namespace tungsten::path {

namespace {

constexpr size_t FewestPaths = 4096, MostPaths = 32768;
/// Scenes with more lights have none of these: each would be reached by few.
constexpr size_t MostEmitters = 64;

bool scattersSmoothly(const Bsdf& bsdf) {
    const LobeMask lobes = bsdf.lobes();
    return (lobes & lobe::Smooth) != 0 && (lobes & lobe::Transmissive) == 0;
}

/// A glowing disk may shine in a narrower cone than its directions are drawn from.
bool shines(const Emitter& emitter, const EmissionSample& emission) {
    const auto* area = std::get_if<AreaEmitter>(&emitter.model);
    const auto* disk = area ? std::get_if<Disk>(area->shape) : nullptr;
    return !disk || emission.ray.direction.dot(emission.normal) >= disk->cosConeAngle;
}

std::optional<LightVertex> traceVertex(const Scene& scene, const Emitter& emitter, float probability, Sampler sampler) {
    const Vec2f uPosition = sampler.next2D();
    const EmissionSample emission = sampleEmission(emitter, uPosition, sampler.next2D());
    if (!shines(emitter, emission)) return std::nullopt;
    const Vec3f direction = emission.ray.direction;
    const auto hit = scene.geometry->intersect(
        {emission.ray.origin, direction, emitter.isArea() ? scene.rayEpsilon : 0.0f, emission.ray.tMax});
    if (!hit || !scattersSmoothly(scene.bsdfOf(*hit))) return std::nullopt;
    LightVertex vertex;
    vertex.surface = makeInteraction(scene, *hit, direction);
    vertex.toLight = -direction;
    const float cosine = std::abs(direction.dot(hit->ng));
    if (!(cosine > 0.0f) || !vertex.surface.consistent(vertex.toLight, scene.transport.consistencyChecks))
        return std::nullopt;
    vertex.power = emission.power / (cosine * probability);
    vertex.distance = hit->t;
    vertex.areaPdf = emission.pdfDirection * cosine / sqr(hit->t);
    vertex.lightPdf = pdfDirect(emitter, hit->position, emission.ray.origin, emission.normal);
    if (isBlack(vertex.power)) return std::nullopt;
    return vertex;
}

} // namespace

Rgb LightVertex::scattered(const Vec3f& direction) const {
    if (!mayBeLightVertex(surface, direction, toLight)) return Rgb(0.0f);
    const Vec3f wi = surface.frame.toLocal(direction), wo = surface.frame.toLocal(toLight);
    const BsdfQuery query = surface.query(TransportMode::Radiance);
    const Rgb value = surface.bsdf->eval(query, wi, wo) * power;
    return lightPdf > 0.0f ? value * powerHeuristic(lightPdf, surface.bsdf->pdf(query, wi, wo)) : value;
}

bool mayBeLightVertex(const SurfaceInteraction& surface, const Vec3f& toVertex, const Vec3f& toLight) {
    return scattersSmoothly(*surface.bsdf) && toVertex.dot(surface.hit.ng) * toLight.dot(surface.hit.ng) > 0.0f;
}

float pdfLightDirection(const Emitter& emitter, const SurfaceSample& point, const Vec3f& direction) {
    if (emitter.isArea()) return std::max(direction.dot(point.normal), 0.0f) * InvPi;
    if (const auto* spot = std::get_if<SpotEmitter>(&emitter.model))
        return direction.dot(spot->direction) >= spot->cosOuter ? warp::squareToConePdf(spot->cosOuter) : 0.0f;
    return warp::squareToSpherePdf();
}

float lightVertexShare(float areaPdf, float walkPdf) {
    const float tried = float(LightVertexCache::Tried) * areaPdf;
    return tried > 0.0f ? tried / (tried + walkPdf) : 0.0f;
}

void LightVertexCache::trace(const Scene& scene, const Emitter& emitter, float probability, size_t paths,
                             const PassInfo& pass) {
    std::vector<std::optional<LightVertex>> found(paths);
    const auto stream = uint64_t(&emitter - scene.emitters.data()) << 32;
    tbb::parallel_for(size_t(0), paths, [&](size_t i) {
        const Sampler sampler(pass.seed, RandomStream::LightVertex, pass.index, stream | i);
        found[i] = traceVertex(scene, emitter, probability, sampler);
    });
    paths_ = paths;
    vertices_.clear();
    for (const auto& vertex : found)
        if (vertex) vertices_.push_back(*vertex);
    for (auto* list : {&x_, &y_, &z_, &length_}) list->clear();
    const size_t count = vertices_.size();
    for (size_t i = 0; count > 0 && i + 1 < count + Tried; ++i) {
        const LightVertex& vertex = vertices_[i % count];
        x_.push_back(vertex.surface.hit.position.x);
        y_.push_back(vertex.surface.hit.position.y);
        z_.push_back(vertex.surface.hit.position.z);
        length_.push_back(vertex.distance);
    }
}

float LightVertexCache::importance(const LightVertex& vertex, const Vec3f& position, float squared) {
    const Vec3f offset = position - vertex.surface.hit.position;
    const float cosine = std::abs(offset.dot(vertex.surface.hit.ng)) / std::sqrt(squared);
    const float walkPdf = 0.25f * InvPi * cosine / squared; // about that of a walk with even directions
    return maxComponent(vertex.power) * walkPdf * lightVertexShare(vertex.areaPdf, walkPdf);
}

auto LightVertexCache::choose(const Vec3f& position, float low, float high, const Vec2f& u) const -> Choice {
    if (vertices_.empty()) return {};
    const size_t count = vertices_.size(), first = std::min(size_t(u.x * float(count)), count - 1);
    const float *x = &x_[first], *y = &y_[first], *z = &z_[first], *length = &length_[first];
    constexpr float Slack = 1e-6f; // rounding; the sensor tests times exactly
    const float from = low - Slack * std::abs(low), to = high + Slack * std::abs(high);
    Window squared;
    std::array<uint32_t, Tried> inside;
    for (size_t i = 0; i < Tried; ++i) { // in full registers
        squared[i] = sqr(x[i] - position.x) + sqr(y[i] - position.y) + sqr(z[i] - position.z);
        const float total = std::sqrt(squared[i]) + length[i];
        inside[i] = uint32_t(total >= from) & uint32_t(total < to);
    }
    Window importances;
    std::array<uint32_t, Tried> candidates;
    size_t number = 0;
    float sum = 0.0f;
    for (uint32_t i = 0; i < Tried; ++i) {
        if (inside[i] == 0) continue;
        const float value = importance(vertices_[(first + i) % count], position, squared[i]);
        if (!(value > 0.0f)) continue;
        candidates[number] = i;
        importances[number++] = value;
        sum += value;
    }
    if (!(sum > 0.0f) || !std::isfinite(sum)) return {};
    float rest = u.y * sum;
    size_t chosen = 0;
    for (; chosen + 1 < number; ++chosen) {
        rest -= importances[chosen];
        if (rest < 0.0f) break;
    }
    const float each = float(count) / (float(paths_) * float(Tried));
    return {&vertices_[(first + candidates[chosen]) % count], each * sum / importances[chosen]};
}

bool LightVertices::helpWith(const Scene& scene) {
    const auto helps = [](const Emitter& emitter) { return !emitter.isDelta() && !emitter.isInfinite(); };
    return scene.emitters.size() <= MostEmitters && std::any_of(scene.emitters.begin(), scene.emitters.end(), helps);
}

void LightVertices::trace(const Scene& scene, const TargetChoice& targets, const PassInfo& pass,
                          Statistics& statistics) {
    const size_t samples = size_t(scene.camera.resolution.x) * size_t(scene.camera.resolution.y) * pass.samples;
    const auto all = float(std::clamp(samples, FewestPaths, MostPaths));
    caches_.resize(scene.emitters.size());
    uint64_t paths = 0;
    for (size_t i = 0; i < caches_.size(); ++i) {
        const float probability = targets.probability(i);
        if (!(probability > 0.0f) || scene.emitters[i].isDelta()) continue;
        caches_[i].trace(scene, scene.emitters[i], probability, size_t(all * probability) + LightVertexCache::Tried,
                         pass);
        paths += caches_[i].paths();
    }
    statistics.add("light paths", paths);
    statistics.add("rays", paths);
}

} // namespace tungsten::path
