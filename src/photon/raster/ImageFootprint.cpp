#include "photon/raster/ImageFootprint.h"

#include <algorithm>

namespace tungsten::photon {

ImageFootprint::ImageFootprint(const Camera& camera)
    : frame_(camera.toWorld.rotation()), origin_(camera.position()), width_(camera.resolution.x),
      height_(camera.resolution.y), margin_(camera.filter.halfWidth() + 0.1f),
      pixelsPerSlope_(0.5f * float(camera.resolution.x) * camera.fieldOfView()->planeDistance) {}

std::optional<ImageFootprint::Slopes> ImageFootprint::slopes(float sideways, float forward, float radius) {
    constexpr float Steepest = 14.0f;
    if (!(forward > radius * 1.0001f)) return std::nullopt;
    // Tangents from the camera to the circle.
    const float power = (forward - radius) * (forward + radius), inverse = 1.0f / power;
    const float middle = sideways * forward * inverse;
    const float spread = radius * std::sqrt(sideways * sideways + power) * inverse;
    if (std::abs(middle) + spread > Steepest) return std::nullopt;
    return Slopes{middle - spread, middle + spread};
}

std::optional<PixelArea> ImageFootprint::area(const std::optional<Slopes>& x, const std::optional<Slopes>& y) const {
    PixelArea area{0, width_ - 1, 0, height_ - 1};
    const float centreX = 0.5f * float(width_), centreY = 0.5f * float(height_);
    if (x) {
        area.left = std::max(area.left, firstPixel(centreX + x->low * pixelsPerSlope_, width_));
        area.right = std::min(area.right, lastPixel(centreX + x->high * pixelsPerSlope_, width_));
    }
    if (y) {
        area.top = std::max(area.top, firstPixel(centreY - y->high * pixelsPerSlope_, height_));
        area.bottom = std::min(area.bottom, lastPixel(centreY - y->low * pixelsPerSlope_, height_));
    }
    if (area.left > area.right || area.top > area.bottom) return std::nullopt;
    return area;
}

std::optional<PixelArea> ImageFootprint::around(const Vec3f& start, const Vec3f& end, float radius) const {
    const Vec3f a = frame_.toLocal(start - origin_), b = frame_.toLocal(end - origin_);
    if (std::max(a.z, b.z) < -radius) return std::nullopt;
    // Between the ends both are in front of the camera: the slopes lie between theirs.
    const auto bounds = [&](float sidewaysA, float sidewaysB) -> std::optional<Slopes> {
        const auto atA = slopes(sidewaysA, a.z, radius), atB = slopes(sidewaysB, b.z, radius);
        if (!atA || !atB) return std::nullopt;
        return Slopes{std::min(atA->low, atB->low), std::max(atA->high, atB->high)};
    };
    return area(bounds(a.x, b.x), bounds(a.y, b.y));
}

std::optional<PixelArea> ImageFootprint::aroundHull(std::span<const Vec3f> points) const {
    std::optional<Slopes> x = Slopes{Infinity, -Infinity}, y = x;
    bool behind = true;
    const auto include = [](std::optional<Slopes>& bounds, const std::optional<Slopes>& of) {
        if (bounds && of)
            bounds = Slopes{std::min(bounds->low, of->low), std::max(bounds->high, of->high)};
        else
            bounds.reset();
    };
    for (const Vec3f& point : points) {
        const Vec3f p = frame_.toLocal(point - origin_);
        behind = behind && p.z < 0.0f;
        include(x, slopes(p.x, p.z, 0.0f));
        include(y, slopes(p.y, p.z, 0.0f));
    }
    return behind ? std::nullopt : area(x, y);
}

std::optional<ImageDisc> ImageFootprint::disc(const Vec3f& point, float radius) const {
    const Vec3f p = frame_.toLocal(point - origin_);
    if (p.z < -radius) return std::nullopt;
    const auto x = slopes(p.x, p.z, radius), y = slopes(p.y, p.z, radius);
    const auto covered = area(x, y);
    if (!covered) return std::nullopt;
    ImageDisc disc{};
    disc.area = *covered;
    disc.ellipse = x && y;
    if (!disc.ellipse) return disc;
    // Directions (X, Y, 1) with (p . d)^2 >= (|p|^2 - r^2) |d|^2: a quadratic inequality in X for given Y.
    const float power = (p.z - radius) * (p.z + radius), inverse = 1.0f / (p.y * p.y + power);
    disc.up = p.y;
    disc.forward = p.z;
    disc.squaredRadius = radius * radius;
    disc.shift = p.x * p.z * inverse;
    disc.slant = p.x * p.y * inverse;
    disc.spread = std::sqrt(p.x * p.x + p.y * p.y + power) * inverse;
    const float height = p.y / (p.x * p.x + power);
    disc.heightOfLeft = height * (p.x * x->low + p.z);
    disc.heightOfRight = height * (p.x * x->high + p.z);
    return disc;
}

ImageFootprint::Columns ImageFootprint::columns(const ImageDisc& disc, int firstRow) const {
    const Batch leftmost(float(disc.area.left)), rightmost(float(disc.area.right));
    Batch left = leftmost, right = rightmost;
    if (disc.ellipse) {
        const float slopesPerPixel = 1.0f / pixelsPerSlope_, reach = margin_ * slopesPerPixel;
        const float centreX = 0.5f * float(width_) - 0.5f, top = 0.5f * float(height_) - 0.5f - float(firstRow);
        const Batch row = (top - Batch::load_aligned(LaneNumbers)) * slopesPerPixel;
        // Chords are longest where the outline is nearest to its extremes.
        const auto edge = [&](float extreme, float spread) {
            const Batch y = xsimd::min(xsimd::max(Batch(extreme), row - reach), row + reach);
            const Batch across = disc.forward * y - disc.up;
            const Batch square = xsimd::max(disc.squaredRadius * (1.0f + y * y) - across * across, Batch(0.0f));
            return centreX + (disc.shift + disc.slant * y + spread * xsimd::sqrt(square)) * pixelsPerSlope_;
        };
        left = xsimd::max(xsimd::ceil(edge(disc.heightOfLeft, -disc.spread) - margin_), leftmost);
        right = xsimd::min(xsimd::floor(edge(disc.heightOfRight, disc.spread) + margin_), rightmost);
        // Chords beside the image are empty.
        left = xsimd::min(left, rightmost + 1.0f);
        right = xsimd::max(right, leftmost - 1.0f);
    }
    Columns columns;
    xsimd::to_int(left).store_aligned(columns.left);
    xsimd::to_int(right).store_aligned(columns.right);
    return columns;
}

int ImageFootprint::firstPixel(float from, int size) const {
    return int(std::ceil(std::min(std::max(from - 0.5f - margin_, -1.0f), float(size))));
}

int ImageFootprint::lastPixel(float to, int size) const {
    return int(std::floor(std::min(std::max(to - 0.5f + margin_, -1.0f), float(size))));
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
    const float edge = -least / half.a;
    if (half.a > 0.0f)
        left = std::max(left, firstPixel(edge, width_));
    else
        right = std::min(right, lastPixel(edge, width_));
}

} // namespace tungsten::photon
