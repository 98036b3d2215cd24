#include "tungsten/camera/Camera.h"

namespace tungsten {

Transform cameraTransform(const Transform& sceneTransform) {
    Transform transform = sceneTransform;
    transform.x = -transform.x;
    return transform;
}

Ray Camera::generateRay(const Vec2i& pixel, const Vec2f& uFilter, const Vec2f& uLens) const {
    const Vec2f offset = filter.sample(uFilter);
    const RasterSample sample{pixel, {float(pixel.x) + offset.x, float(pixel.y) + offset.y}, uFilter, uLens};
    return std::visit([&](const auto& m) { return m.generateRay(*this, sample); }, model);
}

MaybeSensor Camera::sampleSensor(const Vec3f& point, const Vec2f& uLens) const {
    return std::visit([&](const auto& m) { return m.sampleSensor(*this, point, uLens); }, model);
}

std::optional<Vec2f> Camera::project(const Vec3f& point) const {
    const Vec3f local = toWorld.rotation().toLocal(point - position());
    if (local.z <= 0.0f) return std::nullopt;
    return std::visit([&](const auto& m) { return m.project(*this, local); }, model);
}

std::optional<FieldOfView> Camera::fieldOfView() const {
    return std::visit([](const auto& m) { return m.fieldOfView(); }, model);
}

float Camera::aperture() const {
    return std::visit([&](const auto& m) { return m.aperture(*this); }, model);
}

float Camera::focusDistance() const {
    return std::visit([&](const auto& m) { return m.focusDistance(*this); }, model);
}

bool Camera::hasSinglePosition() const {
    return std::visit([](const auto& m) { return m.hasSinglePosition(); }, model);
}

bool Camera::hasParallelRays() const {
    return std::visit([](const auto& m) { return m.hasParallelRays(); }, model);
}

} // namespace tungsten
