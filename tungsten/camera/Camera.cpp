#include "tungsten/camera/Camera.h"

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
    if (const auto* pinhole = std::get_if<Pinhole>(&model)) {
        const Vec3f local = rasterDirection(centre, resolution, pinhole->planeDistance);
        return {position(), toWorld.vector(local.normalized()).normalized()};
    }
    if (const auto* orthographic = std::get_if<Orthographic>(&model)) {
        const float step = 2.0f * orthographic->size / float(resolution.y);
        const float halfWidth = 0.5f * step * float(resolution.x);
        const Vec3f local(-halfWidth + centre.x * step, orthographic->size - centre.y * step, 0.0f);
        return {toWorld.point(local), forward()};
    }
    // The format's thin lens leaves out the half pixel when it generates rays.
    const auto& lens = std::get<ThinLens>(model);
    const Vec3f through = rasterDirection(corner, resolution, lens.planeDistance);
    const Vec3f focus = through * (lens.focusDistance / through.z);
    const Vec2f disk = warp::squareToDisk(uLens);
    const Vec3f start(disk.x * lens.apertureRadius, disk.y * lens.apertureRadius, 0.0f);
    return {toWorld.point(start), toWorld.vector((focus - start).normalized()).normalized()};
}

float Camera::aperture() const {
    const auto* lens = std::get_if<ThinLens>(&model);
    return lens ? lens->apertureRadius * std::max(toWorld.x.length(), toWorld.y.length()) : 0.0f;
}

std::optional<Vec2f> Camera::project(const Vec3f& point) const {
    const Frame frame = toWorld.rotation();
    const Vec3f local = frame.toLocal(point - position());
    if (local.z <= 0.0f) return std::nullopt;
    const float w = float(resolution.x), h = float(resolution.y);
    if (const auto* orthographic = std::get_if<Orthographic>(&model)) {
        const float step = 2.0f * orthographic->size / h;
        return Vec2f(local.x / step + 0.5f * w, 0.5f * h - local.y / step);
    }
    const auto* pinhole = std::get_if<Pinhole>(&model);
    const float distance = pinhole ? pinhole->planeDistance : std::get<ThinLens>(model).planeDistance;
    const float scale = distance / local.z;
    return Vec2f(0.5f * w * (1.0f + local.x * scale), 0.5f * h - 0.5f * w * local.y * scale);
}

} // namespace tungsten
