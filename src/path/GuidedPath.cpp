#include "path/GuidedPath.h"

#include "path/techniques/EmitterConnections.h"
#include "path/techniques/GlossyVertexConnections.h"
#include "path/techniques/LightCaches.h"

namespace tungsten::path {

void WayBehind::approachBy(float pdf, const Vec3f& normal) {
    approach.reset();
    if (caches == Caches::GlossyVerticesToo && pdf > 0.0f) approach = Approach{pdf, normal};
    caches = Caches::None;
}

void WayBehind::approachInMedium(const GuidedContext& context, const PathState& path, float distance) {
    const float ends = caches == Caches::GlossyVerticesToo ? context.lightCaches.flights().pdf(distance) : 0.0f;
    approachBy(path.last.pdf * ends / sqr(distance), Vec3f(0.0f));
}

void WayBehind::approachOnSurface(const StepsToEmitter& steps, const PathState& path, const transport::Vertex& here,
                                  const SurfaceHit& hit) {
    const Vec3f& before = path.ray.direction;
    approachBy(steps.surfaceGuide() ? here.areaDensity(path.last.pdf, before, hit.t) : 0.0f,
               before.dot(hit.ng) < 0.0f ? hit.ng : -hit.ng);
}

void WayBehind::connect(const GuidedContext& context, int emitter, const PathState& path) {
    const Medium* medium = context.scene.medium(path.region);
    if (!context.lightCaches.vertices(emitter) || (medium && path.flights >= medium->maxBounces)) return;
    // Wherever reflected light ends, a walk would connect to light vertices.
    const bool reflected = context.lightCaches.reflected(emitter) && medium && path.flights + 1 < medium->maxBounces;
    caches = reflected ? Caches::GlossyVerticesToo : Caches::LightVertices;
}

float GuidedPath::logRatioByLightCaches(const transport::Vertex& surface, float shareOfWalk) const {
    constexpr float Least = 1e-30f; // of what walks hardly find
    const bool reflected = GlossyVertexConnections::mayFind(*this, surface);
    return (reflected ? behind.ratios.before : behind.ratios.there) - std::log(std::max(shareOfWalk, Least));
}

} // namespace tungsten::path
