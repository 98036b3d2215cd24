#include "photon/ImageFootprint.h"

#include <algorithm>

namespace tungsten::photon {

ImageFootprint::ImageFootprint(const Camera& camera)
    : frame_(camera.toWorld.rotation()), origin_(camera.position()), width_(camera.resolution.x),
      height_(camera.resolution.y), margin_(camera.filter.halfWidth() + 0.1f),
      pixelsPerSlope_(0.5f * float(camera.resolution.x) * std::get<Pinhole>(camera.model).planeDistance) {}

std::optional<ImageFootprint::Slopes> ImageFootprint::slopes(float sideways, float forward, float radius) {
    // Within asin(r / distance) of the direction, between tangent planes.
    constexpr float Widest = 1.5f; // radians
    const float distance = std::sqrt(sideways * sideways + forward * forward);
    if (distance <= radius * 1.0001f) return std::nullopt;
    const float angle = std::atan2(sideways, forward), spread = std::asin(radius / distance);
    if (angle - spread < -Widest || angle + spread > Widest) return std::nullopt;
    return Slopes{std::tan(angle - spread), std::tan(angle + spread)};
}

std::optional<PixelArea> ImageFootprint::around(const Vec3f& start, const Vec3f& end, float radius) const {
    const Vec3f a = frame_.toLocal(start - origin_), b = frame_.toLocal(end - origin_);
    if (std::max(a.z, b.z) < -radius) return std::nullopt;
    PixelArea area{0, width_ - 1, 0, height_ - 1};
    const auto clampPixel = [](float v, int size) { return int(std::clamp(v, -1.0f, float(size))); };
    // Between the ends both are in front of the camera: the slopes lie between theirs.
    const auto bounds = [&](float sidewaysA, float sidewaysB) -> std::optional<Slopes> {
        const auto atA = slopes(sidewaysA, a.z, radius), atB = slopes(sidewaysB, b.z, radius);
        if (!atA || !atB) return std::nullopt;
        return Slopes{std::min(atA->low, atB->low) * pixelsPerSlope_, std::max(atA->high, atB->high) * pixelsPerSlope_};
    };
    const float centreX = 0.5f * float(width_), centreY = 0.5f * float(height_);
    if (const auto x = bounds(a.x, b.x)) {
        area.left = std::max(area.left, clampPixel(std::floor(centreX + x->low - 0.5f - margin_), width_));
        area.right = std::min(area.right, clampPixel(std::ceil(centreX + x->high - 0.5f + margin_), width_));
    }
    if (const auto y = bounds(a.y, b.y)) {
        area.top = std::max(area.top, clampPixel(std::floor(centreY - y->high - 0.5f - margin_), height_));
        area.bottom = std::min(area.bottom, clampPixel(std::ceil(centreY - y->low - 0.5f + margin_), height_));
    }
    if (area.left > area.right || area.top > area.bottom) return std::nullopt;
    return area;
}

ImageHalfPlane ImageFootprint::halfPlane(const Vec3f& normal) const {
    // A direction through (X, Y) is ((X - width / 2) / scale, (height / 2 - Y) / scale, 1).
    const Vec3f n = frame_.toLocal(normal);
    return {n.x, -n.y, n.z * pixelsPerSlope_ - 0.5f * n.x * float(width_) + 0.5f * n.y * float(height_)};
}

void ImageFootprint::narrow(const ImageHalfPlane& half, int y, int& left, int& right) const {
    // a X >= -least for some Y of the row's rays; a little wide against rounding.
    const float reach = std::abs(half.b) * margin_ + 1e-6f * std::abs(half.c);
    const float least = half.b * (float(y) + 0.5f) + half.c + reach;
    if (half.a == 0.0f) {
        if (least < 0.0f) right = left - 1;
        return;
    }
    const float edge = std::clamp(-least / half.a, -2.0f, float(width_) + 2.0f);
    if (half.a > 0.0f)
        left = std::max(left, int(std::floor(edge - 0.5f - margin_)));
    else
        right = std::min(right, int(std::ceil(edge - 0.5f + margin_)));
}

} // namespace tungsten::photon
