#include "photon/light/CameraView.h"

#include "photon/Tuning.h"

namespace tungsten::photon {

CameraView::CameraView(const Camera& camera) : position_(camera.position()), frame_(camera.toWorld.rotation()) {
    const FieldOfView fov = camera.fieldOfView().value_or(FieldOfView());
    aperture_ = camera.aperture() * (1.0f + 1.0f / std::max(camera.focusDistance(), 1e-6f));
    const float width = float(camera.resolution.x), height = float(camera.resolution.y);
    halfWidth_ = 1.0f / fov.planeDistance;
    halfHeight_ = halfWidth_ * height / width;
    // Pixel centres lie inside the image; filters reach a little beyond, the thin lens is off by half a pixel.
    const float pixel = 2.0f * halfWidth_ / width, reach = (camera.filter.halfWidth() + 1.0f) * pixel;
    marginX_ = halfWidth_ + reach;
    marginY_ = halfHeight_ + reach;
    // Directions aim wider than a narrow image: across its edge, where their density leaps, a direction's rounding
    // would mistake many.
    constexpr float Narrowest = 0.01f;
    halfWidth_ = std::max(halfWidth_, Narrowest);
    halfHeight_ = std::max(halfHeight_, Narrowest);
    slantX_ = std::sqrt(1.0f + marginX_ * marginX_);
    slantY_ = std::sqrt(1.0f + marginY_ * marginY_);
}

darts::Vec3 CameraView::sample(float u, float v) const {
    if (u < tuning::SphereShare) return darts::directionAbout({0, 0, 1}, 2.0f * u / tuning::SphereShare, v);
    const float x = (2.0f * (u - tuning::SphereShare) / (1.0f - tuning::SphereShare) - 1.0f) * halfWidth_;
    return darts::vec3(frame_.toWorld(Vec3f(x, (2.0f * v - 1.0f) * halfHeight_, 1.0f)).normalized());
}

float CameraView::pdf(const darts::Vec3& direction) const {
    constexpr float Sphere = tuning::SphereShare / (4.0f * Pi);
    const Vec3f local = frame_.toLocal(Vec3f(direction.x, direction.y, direction.z));
    if (local.z <= 0.0f || std::abs(local.x) > halfWidth_ * local.z || std::abs(local.y) > halfHeight_ * local.z)
        return Sphere;
    return Sphere + (1.0f - tuning::SphereShare) / (4.0f * halfWidth_ * halfHeight_ * local.z * local.z * local.z);
}

std::array<Vec3f, 4> CameraView::sides() const {
    const auto side = [&](const Vec3f& local) { return frame_.toWorld(local.normalized()); };
    return {side({1.0f, 0.0f, -marginX_}), side({-1.0f, 0.0f, -marginX_}), side({0.0f, 1.0f, -marginY_}),
            side({0.0f, -1.0f, -marginY_})};
}

bool CameraView::sees(const Vec3f& point, float radius) const {
    const Vec3f local = frame_.toLocal(point - position_);
    const float reach = radius + aperture_ * (1.0f + std::max(local.z, 0.0f));
    return local.z > -reach && std::abs(local.x) <= marginX_ * local.z + slantX_ * reach &&
           std::abs(local.y) <= marginY_ * local.z + slantY_ * reach;
}

FlightPart CameraView::seenPart(const Vec3f& origin, const Vec3f& direction, float radius) const {
    FlightPart part{0.0, std::numeric_limits<double>::infinity()};
    if (aperture_ > 0.0f) return part;
    const Vec3f from = frame_.toLocal(origin - position_), along = frame_.toLocal(direction);
    // value + s slope >= 0, a little wide against rounding.
    const auto clip = [&](double value, double slope) {
        value += 1e-5 * (std::abs(value) + double(radius));
        if (slope > 0.0) part.start = std::max(part.start, -value / slope);
        if (slope < 0.0) part.end = std::min(part.end, -value / slope);
        if (slope == 0.0 && value < 0.0) part.end = -1.0;
    };
    clip(double(from.z + radius), double(along.z));
    for (const float side : {-1.0f, 1.0f}) {
        clip(double(marginX_ * from.z + side * from.x + slantX_ * radius), double(marginX_ * along.z + side * along.x));
        clip(double(marginY_ * from.z + side * from.y + slantY_ * radius), double(marginY_ * along.z + side * along.y));
    }
    return part;
}

} // namespace tungsten::photon
