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
        Overloaded{[&](const Pinhole& pinhole) -> Ray {
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
                   }},
        model);
}

std::optional<Vec2f> Camera::project(const Vec3f& point) const {
    const Frame frame = toWorld.rotation();
    const Vec3f local = frame.toLocal(point - position());
    if (local.z <= 0.0f) return std::nullopt;
    const float w = float(resolution.x), h = float(resolution.y);
    return std::visit(Overloaded{[&](const OneOf<Pinhole, ThinLens> auto& fov) {
                                     const float scale = fov.planeDistance / local.z;
                                     return Vec2f(0.5f * w * (1.0f + local.x * scale),
                                                  0.5f * h - 0.5f * w * local.y * scale);
                                 },
                                 [&](const Orthographic& orthographic) {
                                     const float step = 2.0f * orthographic.size / h;
                                     return Vec2f(local.x / step + 0.5f * w, 0.5f * h - local.y / step);
                                 }},
                      model);
}

std::optional<FieldOfView> Camera::fieldOfView() const {
    using Answer = std::optional<FieldOfView>;
    return std::visit(Overloaded{[](const OneOf<Pinhole, ThinLens> auto& fov) { return Answer(fov); },
                                 [](const Orthographic&) { return Answer(); }},
                      model);
}

float Camera::aperture() const {
    return std::visit(Overloaded{[&](const ThinLens& lens) {
                                     return lens.apertureRadius * std::max(toWorld.x.length(), toWorld.y.length());
                                 },
                                 [](const OneOf<Pinhole, Orthographic> auto&) { return 0.0f; }},
                      model);
}

float Camera::focusDistance() const {
    return std::visit(Overloaded{[&](const ThinLens& lens) { return lens.focusDistance * toWorld.z.length(); },
                                 [](const OneOf<Pinhole, Orthographic> auto&) { return Infinity; }},
                      model);
}

bool Camera::hasSinglePosition() const {
    return std::visit(Overloaded{[](const Pinhole&) { return true; },
                                 [](const OneOf<ThinLens, Orthographic> auto&) { return false; }},
                      model);
}

bool Camera::hasParallelRays() const {
    return std::visit(Overloaded{[](const Orthographic&) { return true; },
                                 [](const OneOf<Pinhole, ThinLens> auto&) { return false; }},
                      model);
}

} // namespace tungsten
