#include "photon/DefaultRadius.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tungsten::photon {

namespace {

constexpr int RaysPerSide = 8;
constexpr float PartOfSpan = 0.01f, LeastPart = 0.1f, FreePaths = 3.0f;

Ray rayThrough(const Camera& camera, float u, float v) {
    const Vec2i pixel{std::min(int(u * float(camera.resolution.x)), camera.resolution.x - 1),
                      std::min(int(v * float(camera.resolution.y)), camera.resolution.y - 1)};
    return camera.generateRay(pixel, Vec2f(0.5f), Vec2f(0.5f));
}

/// How far a ray of the image sees at most, for the medium about the camera.
float farthest(const Scene& scene) {
    const int medium = scene.cameraRegion.medium;
    if (medium < 0 || !scene.media[size_t(medium)].isHomogeneous()) return Infinity;
    const float density = meanComponent(scene.media[size_t(medium)].sigmaT());
    return density > 0.0f ? FreePaths / density : Infinity;
}

/// The median of what rays all over the image see; where most see nothing, the way to the middle of the objects.
float depthOf(const Scene& scene) {
    std::vector<float> depths;
    for (int y = 0; y < RaysPerSide; ++y)
        for (int x = 0; x < RaysPerSide; ++x) {
            const auto hit = scene.geometry->intersect(
                rayThrough(scene.camera, (float(x) + 0.5f) / RaysPerSide, (float(y) + 0.5f) / RaysPerSide));
            depths.push_back(hit ? hit->t : Infinity);
        }
    std::nth_element(depths.begin(), depths.begin() + std::ssize(depths) / 2, depths.end());
    const float depth = std::min(depths[depths.size() / 2], farthest(scene));
    if (depth < Infinity) return depth;
    const Vec3f middle = (scene.geometry->boundsMin() + scene.geometry->boundsMax()) * 0.5f;
    const float distance = (middle - scene.camera.position()).length();
    return distance > 0.0f ? distance : 1.0f;
}

} // namespace

DefaultRadius DefaultRadius::of(const Scene& scene) {
    const float depth = depthOf(scene);
    const Ray left = rayThrough(scene.camera, 0.0f, 0.5f), right = rayThrough(scene.camera, 1.0f, 0.5f);
    const float span = ((left.origin + left.direction * depth) - (right.origin + right.direction * depth)).length();
    const float ofSpan = PartOfSpan * (span > 0.0f ? span : depth);
    const TimeGate& gate = scene.transport.gate;
    const bool lasts = !gate.steadyState && !gate.delta;
    const float inFrame = lasts ? float(gate.frameWidth) * scene.cameraRegion.speed : Infinity;
    const float radius = std::min(ofSpan, std::max(inFrame, LeastPart * ofSpan));
    char text[200];
    std::snprintf(text, sizeof text, "%.3g, as the scene names no volume_gather_radius: %s", double(radius),
                  radius < ofSpan && radius == inFrame ? "what light travels in a frame"
                  : radius < ofSpan ? "a thousandth of what the image spans, as frames are narrower still"
                                    : "a hundredth of what the image spans at the depth that it shows");
    return {radius, text};
}

} // namespace tungsten::photon
