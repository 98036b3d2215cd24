#pragma once
// What a camera's model answers. Raster: pixel (0,0) is the top left, y grows downward.

#include "tungsten/core/ModelSet.h"
#include "tungsten/core/Transform.h"

#include <cmath>
#include <concepts>
#include <optional>

namespace tungsten {

/// A connection from a point to the sensor.
struct SensorSample {
    Vec3f direction; ///< from the point, unit
    float distance;
    /// Power scattered per steradian towards the sensor, times this, is what the point adds to the image per pixel of
    /// area about `raster`: the density of raster positions per solid angle over distance^2 (orthographic: per area
    /// across the rays), divided by the density of the place on the lens. Of detectors: cosine over distance^2, by
    /// the etendue and the density of the place on which one. Visibility not included.
    float weight;
    Vec2f raster; ///< position in the image, in pixels; whole numbers are the centres of filters
};
using MaybeSensor = std::optional<SensorSample>;

/// Horizontal; both are set by the constructor alone.
struct FieldOfView {
    float fovDegrees;
    float planeDistance; ///< of the image plane that spans [-1, 1]: 1 / tan(fov / 2)

    FieldOfView(float degrees = 60.0f) : fovDegrees(degrees), planeDistance(1.0f / std::tan(degrees * Pi / 360.0f)) {}
};

/// Where a model stands, and its raster.
struct CameraPlacement {
    Vec2i resolution{1000, 563};
    Transform toWorld; ///< x axis already negated: looks along +z with y up (docs/scene-format.md, section 3)

    [[nodiscard]] Vec3f position() const { return toWorld.translation; }
    [[nodiscard]] Vec3f forward() const { return toWorld.z.normalized(); }
    /// Of a point of the world.
    [[nodiscard]] Vec3f local(const Vec3f& point) const { return toWorld.inverseVector(point - position()); }
    /// Volume of the world by that of the camera's frame.
    [[nodiscard]] float volume() const { return std::abs(toWorld.determinant()); }
};

/// Of one ray: the pixel, the place in it by its filter, and two pairs of numbers.
struct RasterSample {
    Vec2i pixel;
    Vec2f corner; ///< pixel and the filter's offset
    Vec2f uFilter, uLens;

    [[nodiscard]] Vec2f centre() const { return {corner.x + 0.5f, corner.y + 0.5f}; }
};

class Camera;
class CameraReader;

/// Each as the function of that name says (Camera.h).
template <typename M>
concept CameraModel = std::copyable<M> &&
    requires(const M& m, const CameraPlacement& at, const RasterSample& sample, const Vec3f& v, const Vec2f& u,
             const CameraReader& fields, Camera& camera) {
    { M::Type } -> std::convertible_to<std::string>; // of the scene file
    M::read(fields, camera);                         // sets camera.model, and what follows from it
    { m.generateRay(at, sample) } -> std::same_as<Ray>;
    { m.sampleSensor(at, v, u) } -> std::same_as<MaybeSensor>;
    { m.project(at, v) } -> std::same_as<std::optional<Vec2f>>; // a point of the camera's rotation, before it
    { m.aperture(at) } -> std::same_as<float>;
    { m.focusDistance(at) } -> std::same_as<float>;
    { m.fieldOfView() } -> std::same_as<std::optional<FieldOfView>>;
    { m.hasSinglePosition() } -> std::same_as<bool>;
    { m.hasParallelRays() } -> std::same_as<bool>;
};
template <CameraModel M>
using CheckedCamera = M;
template <typename... M>
using CameraSet = ModelSet<CheckedCamera<M>...>;

/// What cameras answer alike whose rays start from no point in common.
struct CameraBase {
    [[nodiscard]] float aperture(const CameraPlacement&) const { return 0.0f; }
    [[nodiscard]] float focusDistance(const CameraPlacement&) const { return Infinity; }
    [[nodiscard]] std::optional<FieldOfView> fieldOfView() const { return std::nullopt; }
    [[nodiscard]] bool hasSinglePosition() const { return false; }
    [[nodiscard]] bool hasParallelRays() const { return true; }
};

} // namespace tungsten
