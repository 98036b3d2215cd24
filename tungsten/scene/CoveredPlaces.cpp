// Lights and detectors that surfaces cover or touch.

#include "tungsten/scene/LoadEmitters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tungsten {

namespace {

/// The first surface that a point lies in, but for rounding or `within` that length; none if it is clear of all.
std::optional<uint32_t> surfaceAt(const Scene& scene, const Vec3f& position, float within = 0.0f) {
    const float rounding =
        std::max(within, 8.0f * std::numeric_limits<float>::epsilon() *
                             std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z), 1e-20f}));
    for (const Vec3f& axis : {Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)}) {
        Ray across{position - axis * rounding, axis};
        across.tMax = 2.0f * rounding;
        if (const auto hit = scene.geometry->intersect(across)) return hit->shape;
    }
    return std::nullopt;
}

/// Light that does not come from an emitter right behind it cannot pass.
bool isWall(const Scene& scene, const SurfaceHit& hit) {
    const Primitive& primitive = scene.primitives[hit.shape];
    return primitive.emitter < 0 && !primitive.boundsRegion && (scene.bsdfOf(hit).lobes() & lobe::AnyTransmission) == 0;
}

/// No light is in sight from here.
bool isDark(const Scene& scene, const Vec3f& position) {
    return std::none_of(scene.emitters.begin(), scene.emitters.end(), [&](const Emitter& emitter) {
        const Vec3f way = boundingSphere(emitter).centre - position;
        if (emitter.isInfinite() || !(way.length() > 0.0f)) return true;
        Ray ray{position, way.normalized()};
        ray.tMax = way.length();
        const auto hit = scene.geometry->intersect(ray);
        return !hit || !isWall(scene, *hit);
    });
}

/// What covers it: a wall nearer than its radius wherever it looks, or one all around it. Null if it may see.
const Primitive* wallAbout(const Scene& scene, const Detector& detector) {
    constexpr int Side = 6;
    const Ray back{detector.position, -detector.frame.n};
    const auto behind = scene.geometry->intersect(back);
    const bool dark = isDark(scene, detector.position);
    const Primitive* wall = nullptr;
    for (int k = 0; k < Side * Side; ++k) {
        const int column = k % Side, row = k / Side;
        const Vec2f u((float(column) + 0.5f) / Side, (float(row) + 0.5f) / Side);
        const Ray ray = detector.sampleRay({u.y, u.x}, u);
        const auto hit = scene.geometry->intersect(ray);
        if (!hit || !isWall(scene, *hit)) return nullptr;
        const bool inside = dark && behind && behind->shape == hit->shape && hit->ng.dot(ray.direction) > 0.0f &&
                            behind->ng.dot(back.direction) > 0.0f;
        if (!inside && hit->t >= detector.radius) return nullptr;
        wall = &scene.primitives[hit->shape];
    }
    return wall;
}

/// A surface that the middle of its disc lies in. Null if it is clear of all.
const Primitive* surfaceUnder(const Scene& scene, const Detector& detector) {
    constexpr float PartOfRadius = 1e-4f;
    const auto surface = surfaceAt(scene, detector.position, PartOfRadius * detector.radius);
    return surface ? &scene.primitives[*surface] : nullptr;
}

/// A surface between the middle of its disc and its edge, through which no light comes. Null if the disc is in one
/// place.
const Primitive* surfaceAcross(const Scene& scene, const Detector& detector) {
    constexpr int Spokes = 32;
    for (int k = 0; k < Spokes; ++k) {
        const float angle = 2.0f * Pi * float(k) / Spokes;
        Ray spoke{detector.position, detector.frame.s * std::cos(angle) + detector.frame.t * std::sin(angle)};
        spoke.tMax = detector.radius;
        const auto hit = scene.geometry->intersect(spoke);
        if (hit && (scene.bsdfOf(*hit).lobes() & lobe::AnyTransmission) == 0) return &scene.primitives[hit->shape];
    }
    return nullptr;
}

std::string textOf(const Primitive& primitive) {
    return primitive.name.empty() ? primitive.path : "'" + primitive.name + "'";
}

} // namespace

void warnAboutLightsOnSurfaces(const LoadContext& context) {
    const Scene& scene = context.scene;
    constexpr size_t MostLooked = 1000; // at lights: a warning is not worth more
    for (size_t i = 0; i < std::min(context.emitters.size(), MostLooked); ++i) {
        const Emitter& emitter = scene.emitters[i];
        if (emitter.isInfinite() || emitter.primitive()) continue;
        const auto surface = surfaceAt(scene, boundingSphere(emitter).centre);
        if (!surface) continue;
        context.emitters[i].warn("transform", "light '" + emitter.name + "' lies in the surface '" +
                                                  scene.primitives[*surface].name +
                                                  "': rounding decides whether it is seen; move it off a little");
    }
}

void warnAboutBlindDetectors(const LoadContext& context, const ObjectReader& camera) {
    const Scene& scene = context.scene;
    const auto* detectors = scene.camera.detectors();
    for (size_t i = 0; detectors && i < detectors->row.size(); ++i) {
        const Detector& detector = detectors->row[i];
        const auto tell = [&](const std::string& what) {
            camera.warn("detectors[" + std::to_string(i) + "]",
                        (detector.name.empty() ? "" : "'" + detector.name + "' ") + what);
        };
        if (const Primitive* wall = wallAbout(scene, detector))
            tell("sees nothing but " + textOf(*wall) +
                 ": it lies inside a wall, or looks into one nearer than its own radius");
        else if (const Primitive* surface = surfaceUnder(scene, detector))
            tell("lies in the surface " + textOf(*surface) +
                 ": rounding decides what it sees; move it off a little, to where it looks");
        else if (const Primitive* cut = surfaceAcross(scene, detector))
            tell("reaches through " + textOf(*cut) + ": that part of its disc (radius " +
                 brief(double(detector.radius)) + ") sees what is behind; make it smaller or move it");
    }
}

} // namespace tungsten
