#include "tungsten/camera/Camera.h"

#include "tungsten/core/Overloaded.h"
#include "tungsten/core/Warp.h"

namespace tungsten {

namespace {

/// Local, unnormalised direction through a raster position.
Vec3f rasterDirection(const Vec2f& p, const Vec2i& resolution, float distance) {
    const float w = float(resolution.x), h = float(resolution.y);
    return {-1.0f + 2.0f * p.x / w, h / w - 2.0f * p.y / w, distance};
}

/// Inverse of rasterDirection, for a point on its plane.
Vec2f rasterOf(const Vec3f& onPlane, const Vec2i& resolution) {
    const float w = float(resolution.x), h = float(resolution.y);
    return {0.5f * w * (1.0f + onPlane.x), 0.5f * (h - w * onPlane.y)};
}

/// A connection to any place of any detector: one of them, all alike, then a point of its disc.
std::optional<SensorSample> sampleDetectors(const Detectors& detectors, const Vec3f& point, const Vec2f& u) {
    const float count = float(detectors.row.size()), scaled = u.x * count;
    const auto index = std::min(size_t(scaled), detectors.row.size() - 1);
    auto sample = detectors.sample(index, point, {std::min(scaled - float(index), 1.0f), u.y});
    if (sample) sample->weight *= count;
    return sample;
}

} // namespace

Transform cameraTransform(const Transform& sceneTransform) {
    Transform transform = sceneTransform;
    transform.x = -transform.x;
    return transform;
}

Ray Camera::generateRay(const Vec2i& pixel, const Vec2f& uFilter, const Vec2f& uLens) const {
    const Vec2f offset = filter.sample(uFilter);
    const Vec2f corner(float(pixel.x) + offset.x, float(pixel.y) + offset.y);
    const Vec2f centre(corner.x + 0.5f, corner.y + 0.5f);
    return std::visit(
        Overloaded{
            [&](const Pinhole& pinhole) -> Ray {
                const Vec3f local = rasterDirection(centre, resolution, pinhole.planeDistance);
                return {position(), toWorld.vector(local.normalized()).normalized()};
            },
            [&](const ThinLens& lens) -> Ray {
                // The format's thin lens leaves out the half pixel when it generates rays.
                const Vec3f through = rasterDirection(corner, resolution, lens.planeDistance);
                const Vec3f focus = through * (lens.focusDistance / through.z);
                const Vec2f disk = warp::squareToDisk(uLens);
                const Vec3f start(disk.x * lens.apertureRadius, disk.y * lens.apertureRadius, 0.0f);
                return {toWorld.point(start), toWorld.vector((focus - start).normalized()).normalized()};
            },
            [&](const Orthographic& orthographic) -> Ray {
                const float step = 2.0f * orthographic.size / float(resolution.y);
                const float halfWidth = 0.5f * step * float(resolution.x);
                const Vec3f local(-halfWidth + centre.x * step, orthographic.size - centre.y * step, 0.0f);
                return {toWorld.point(local), forward()};
            },
            [&](const Detectors& detectors) { return detectors.row[size_t(pixel.x)].sampleRay(uLens, uFilter); }},
        model);
}

std::optional<SensorSample> Camera::sampleSensor(const Vec3f& point, const Vec2f& uLens) const {
    const Vec3f local = toWorld.inverseVector(point - position());
    const float volume = std::abs(toWorld.determinant());
    // Raster area per solid angle of the camera frame is (plane w / 2)^2 / cos^3 for both views with a field; the
    // world's solid angle is `volume` |along|^3 / distance^3 of that.
    const auto through = [&](const Vec3f& along, float plane, const Vec2f& raster) {
        const Vec3f offset = toWorld.vector(along);
        const float distance = offset.length(), cubed = along.z * along.z * along.z;
        const float weight = 0.25f * sqr(plane * float(resolution.x)) / volume * distance / cubed;
        return SensorSample{-offset / distance, distance, weight, raster};
    };
    return std::visit(
        Overloaded{
            [&](const Pinhole& pinhole) -> std::optional<SensorSample> {
                if (!(local.z > 0.0f)) return std::nullopt;
                const Vec2f raster = rasterOf(local * (pinhole.planeDistance / local.z), resolution);
                return through(local, pinhole.planeDistance, raster - Vec2f(0.5f));
            },
            [&](const ThinLens& lens) -> std::optional<SensorSample> {
                const Vec2f disk = warp::squareToDisk(uLens) * lens.apertureRadius;
                const Vec3f start(disk.x, disk.y, 0.0f), along = local - start;
                if (!(along.z > 0.0f)) return std::nullopt;
                // Where the ray crosses the plane of focus, seen from the middle of the lens; no half pixel, as in
                // generateRay.
                const Vec3f focus = start + along * (lens.focusDistance / along.z);
                return through(along, lens.planeDistance, rasterOf(focus * (lens.planeDistance / focus.z), resolution));
            },
            [&](const Orthographic& orthographic) -> std::optional<SensorSample> {
                if (!(local.z > 0.0f)) return std::nullopt;
                const float step = 2.0f * orthographic.size / float(resolution.y), depth = toWorld.z.length();
                const Vec2f raster(local.x / step + 0.5f * float(resolution.x),
                                   0.5f * float(resolution.y) - local.y / step);
                return SensorSample{-forward(), local.z * depth, depth / (sqr(step) * volume), raster - Vec2f(0.5f)};
            },
            [&](const Detectors& detectors) { return sampleDetectors(detectors, point, uLens); }},
        model);
}

std::optional<Vec2f> Camera::project(const Vec3f& point) const {
    const Frame frame = toWorld.rotation();
    const Vec3f local = frame.toLocal(point - position());
    if (local.z <= 0.0f) return std::nullopt;
    const float w = float(resolution.x), h = float(resolution.y);
    using Answer = std::optional<Vec2f>;
    return std::visit(Overloaded{[&](const OneOf<Pinhole, ThinLens> auto& fov) -> Answer {
                                     const float scale = fov.planeDistance / local.z;
                                     return Vec2f(0.5f * w * (1.0f + local.x * scale),
                                                  0.5f * h - 0.5f * w * local.y * scale);
                                 },
                                 [&](const Orthographic& orthographic) -> Answer {
                                     const float step = 2.0f * orthographic.size / h;
                                     return Vec2f(local.x / step + 0.5f * w, 0.5f * h - local.y / step);
                                 },
                                 [](const Detectors&) -> Answer { return std::nullopt; }},
                      model);
}

const Detectors* Camera::detectors() const {
    return std::visit(
        Overloaded{[](const Detectors& detectors) { return &detectors; },
                   [](const OneOf<Pinhole, ThinLens, Orthographic> auto&) -> const Detectors* { return nullptr; }},
        model);
}

std::optional<FieldOfView> Camera::fieldOfView() const {
    using Answer = std::optional<FieldOfView>;
    return std::visit(Overloaded{[](const OneOf<Pinhole, ThinLens> auto& fov) { return Answer(fov); },
                                 [](const OneOf<Orthographic, Detectors> auto&) { return Answer(); }},
                      model);
}

float Camera::aperture() const {
    return std::visit(Overloaded{[&](const ThinLens& lens) {
                                     return lens.apertureRadius * std::max(toWorld.x.length(), toWorld.y.length());
                                 },
                                 [](const OneOf<Pinhole, Orthographic, Detectors> auto&) { return 0.0f; }},
                      model);
}

float Camera::focusDistance() const {
    return std::visit(Overloaded{[&](const ThinLens& lens) { return lens.focusDistance * toWorld.z.length(); },
                                 [](const OneOf<Pinhole, Orthographic, Detectors> auto&) { return Infinity; }},
                      model);
}

bool Camera::hasSinglePosition() const {
    return std::visit(Overloaded{[](const Pinhole&) { return true; },
                                 [](const OneOf<ThinLens, Orthographic, Detectors> auto&) { return false; }},
                      model);
}

bool Camera::hasParallelRays() const {
    return std::visit(Overloaded{[](const OneOf<Orthographic, Detectors> auto&) { return true; },
                                 [](const OneOf<Pinhole, ThinLens> auto&) { return false; }},
                      model);
}

} // namespace tungsten
