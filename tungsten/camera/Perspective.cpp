#include "tungsten/camera/Perspective.h"

#include "tungsten/camera/CameraReader.h"
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

/// Raster area per solid angle of the camera frame is (plane w / 2)^2 / cos^3 for both views; the world's solid angle
/// is the frame's volume times |along|^3 / distance^3 of that.
SensorSample through(const CameraPlacement& at, const Vec3f& along, float plane, const Vec2f& raster) {
    const Vec3f offset = at.toWorld.vector(along);
    const float distance = offset.length(), cubed = along.z * along.z * along.z;
    const float weight = 0.25f * sqr(plane * float(at.resolution.x)) / at.volume() * distance / cubed;
    return {-offset / distance, distance, weight, raster};
}

} // namespace

std::optional<Vec2f> Perspective::project(const CameraPlacement& at, const Vec3f& local) const {
    const float w = float(at.resolution.x), h = float(at.resolution.y), scale = planeDistance / local.z;
    return Vec2f(0.5f * w * (1.0f + local.x * scale), 0.5f * h - 0.5f * w * local.y * scale);
}

Ray Pinhole::generateRay(const CameraPlacement& at, const RasterSample& sample) const {
    const Vec3f local = rasterDirection(sample.centre(), at.resolution, planeDistance);
    return {at.position(), at.toWorld.vector(local.normalized()).normalized()};
}

MaybeSensor Pinhole::sampleSensor(const CameraPlacement& at, const Vec3f& point, const Vec2f&) const {
    const Vec3f local = at.local(point);
    if (!(local.z > 0.0f)) return std::nullopt;
    const Vec2f raster = rasterOf(local * (planeDistance / local.z), at.resolution);
    return through(at, local, planeDistance, raster - Vec2f(0.5f));
}

void Pinhole::read(const CameraReader& fields, Camera& camera) {
    camera.model = Pinhole{fields.fov()};
    fields.accept({"orthographic_size"});
}

Ray ThinLens::generateRay(const CameraPlacement& at, const RasterSample& sample) const {
    // The format's thin lens leaves out the half pixel when it generates rays.
    const Vec3f ahead = rasterDirection(sample.corner, at.resolution, planeDistance);
    const Vec3f focus = ahead * (distanceOfFocus / ahead.z);
    const Vec2f disk = warp::squareToDisk(sample.uLens);
    const Vec3f start(disk.x * apertureRadius, disk.y * apertureRadius, 0.0f);
    return {at.toWorld.point(start), at.toWorld.vector((focus - start).normalized()).normalized()};
}

MaybeSensor ThinLens::sampleSensor(const CameraPlacement& at, const Vec3f& point, const Vec2f& uLens) const {
    const Vec2f disk = warp::squareToDisk(uLens) * apertureRadius;
    const Vec3f start(disk.x, disk.y, 0.0f), along = at.local(point) - start;
    if (!(along.z > 0.0f)) return std::nullopt;
    // Where the ray crosses the plane of focus, seen from the middle of the lens; no half pixel, as in generateRay.
    const Vec3f focus = start + along * (distanceOfFocus / along.z);
    return through(at, along, planeDistance, rasterOf(focus * (planeDistance / focus.z), at.resolution));
}

float CameraReader::pivotDistance(const Vec3f& cameraPosition, float distance) const {
    const std::string pivot =
        text("focus_pivot", "", {"none", "name of a primitive whose origin's distance is the focus distance"});
    if (!has("focus_pivot")) return distance;
    for (size_t i = 0; i < scene_.arraySize("primitives"); ++i) {
        const auto primitive = scene_.arrayObject("primitives", i);
        if (!primitive || !primitive->isText("name") || primitive->text("name", "", NameMeaning) != pivot) continue;
        return std::max((primitive->transform("transform", PlacementMeaning).translation - cameraPosition).length(),
                        1e-6f);
    }
    problem("focus_pivot", "there is no primitive called '" + pivot + "'");
    return distance;
}

void ThinLens::read(const CameraReader& fields, Camera& camera) {
    ThinLens lens{fields.fov()};
    lens.distanceOfFocus = float(fields.number("focus_distance", 1.0, {"length", "of the sharp plane, along the axis"},
                                               CameraReader::LensRange));
    lens.apertureRadius = float(
        fields.number("aperture_size", 0.001, {"length", "radius of the lens"}, {0.0, CameraReader::LensRange.high}));
    constexpr Meaning cateye{"none", "not simulated: the whole lens is open towards every pixel"};
    if (fields.number("cateye", 0.0, cateye, Range::nonNegative()) > 0.0) fields.warn("cateye", cateye.text);
    constexpr Meaning shape{"none", "shape of the lens"};
    fields.declare("aperture", "an object of type disk", "a disk", shape);
    const auto aperture = fields.isObject("aperture") ? fields.object("aperture", shape) : std::nullopt;
    if (fields.has("aperture") && (!aperture || aperture->text("type", "", {"none", "which shape"}) != "disk"))
        fields.problem("aperture", "only the disk aperture is supported");
    lens.distanceOfFocus = fields.pivotDistance(camera.position(), lens.distanceOfFocus);
    camera.model = lens;
}

} // namespace tungsten
