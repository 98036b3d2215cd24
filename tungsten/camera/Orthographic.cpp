#include "tungsten/camera/CameraReader.h"

namespace tungsten {

Ray Orthographic::generateRay(const CameraPlacement& at, const RasterSample& sample) const {
    const float step = 2.0f * size / float(at.resolution.y);
    const float halfWidth = 0.5f * step * float(at.resolution.x);
    const Vec2f centre = sample.centre();
    const Vec3f local(-halfWidth + centre.x * step, size - centre.y * step, 0.0f);
    return {at.toWorld.point(local), at.forward()};
}

MaybeSensor Orthographic::sampleSensor(const CameraPlacement& at, const Vec3f& point, const Vec2f&) const {
    const Vec3f local = at.local(point);
    if (!(local.z > 0.0f)) return std::nullopt;
    const float step = 2.0f * size / float(at.resolution.y), depth = at.toWorld.z.length();
    const Vec2f raster(local.x / step + 0.5f * float(at.resolution.x), 0.5f * float(at.resolution.y) - local.y / step);
    return SensorSample{-at.forward(), local.z * depth, depth / (sqr(step) * at.volume()), raster - Vec2f(0.5f)};
}

std::optional<Vec2f> Orthographic::project(const CameraPlacement& at, const Vec3f& local) const {
    const float w = float(at.resolution.x), h = float(at.resolution.y), step = 2.0f * size / h;
    return Vec2f(local.x / step + 0.5f * w, 0.5f * h - local.y / step);
}

void Orthographic::read(const CameraReader& fields, Camera& camera) {
    camera.model = Orthographic{
        {},
        float(fields.number("orthographic_size", 1.0, {"length", "half the image's height"}, CameraReader::LensRange))};
    fields.accept({"fov"});
}

} // namespace tungsten
