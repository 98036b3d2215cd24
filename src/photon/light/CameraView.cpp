#include "photon/light/CameraView.h"

namespace tungsten::photon {

CameraView::CameraView(const Camera& camera) : position_(camera.position()), frame_(camera.toWorld.rotation()) {
    const FieldOfView fov = camera.fieldOfView().value_or(FieldOfView());
    aperture_ = camera.aperture() * (1.0f + 1.0f / std::max(camera.focusDistance(), 1e-6f));
    const float width = float(camera.resolution.x), height = float(camera.resolution.y);
    const float halfWidth = 1.0f / fov.planeDistance, halfHeight = halfWidth * height / width;
    // Pixel centres lie inside the image; filters reach a little beyond, the thin lens is off by half a pixel.
    const float pixel = 2.0f * halfWidth / width, reach = (camera.filter.halfWidth() + 1.0f) * pixel;
    marginX_ = halfWidth + reach;
    marginY_ = halfHeight + reach;
    slantX_ = std::sqrt(1.0f + marginX_ * marginX_);
    slantY_ = std::sqrt(1.0f + marginY_ * marginY_);
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
