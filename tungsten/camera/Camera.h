#pragma once
// Cameras: pinhole, thin lens, orthographic, detectors. Raster: pixel (0,0) is the top left, y grows downward.

#include "tungsten/camera/Detectors.h"
#include "tungsten/camera/ReconstructionFilter.h"
#include "tungsten/core/Transform.h"

#include <cmath>
#include <optional>
#include <variant>

namespace tungsten {

/// Horizontal; both are set by the constructor alone.
struct FieldOfView {
    float fovDegrees;
    float planeDistance; ///< of the image plane that spans [-1, 1]: 1 / tan(fov / 2)

    FieldOfView(float degrees = 60.0f) : fovDegrees(degrees), planeDistance(1.0f / std::tan(degrees * Pi / 360.0f)) {}
};
struct Pinhole : FieldOfView {};
struct ThinLens : FieldOfView {
    float focusDistance = 1.0f; ///< along the axis
    float apertureRadius = 0.001f;
};
struct Orthographic {
    float size = 1.0f; ///< half the image height
};

/// Camera-to-world plus raster. The frame looks along +z of the transform with y up and the x axis negated
/// (docs/scene-format.md, section 3).
class Camera {
  public:
    std::variant<Pinhole, ThinLens, Orthographic, Detectors> model;
    Vec2i resolution{1000, 563};
    Transform toWorld; ///< x axis already negated
    ReconstructionFilter filter;

    /// Ray through raster position `pixel` + 0.5 + filter offset; weight 1. `uLens` is used by the thin lens and
    /// detectors; to detectors `uFilter` is the direction.
    [[nodiscard]] Ray generateRay(const Vec2i& pixel, const Vec2f& uFilter, const Vec2f& uLens) const;
    /// The ray of generateRay that meets `point` after leaving the lens where `uLens` says; none behind the camera. The
    /// raster position may lie outside the image.
    [[nodiscard]] std::optional<SensorSample> sampleSensor(const Vec3f& point, const Vec2f& uLens) const;
    [[nodiscard]] Vec3f position() const { return toWorld.translation; }
    [[nodiscard]] Vec3f forward() const { return toWorld.z.normalized(); }
    /// Raster position of a world point (pinhole and thin lens: through the lens centre; orthographic: along the axis);
    /// none behind the camera. May lie outside the image.
    [[nodiscard]] std::optional<Vec2f> project(const Vec3f& point) const;
    /// How far from position() the rays of a lens start at most: its radius in the world; 0 for other cameras.
    [[nodiscard]] float aperture() const;
    /// How far from it, along the axis, the rays of a lens through one raster position meet; Infinity for other
    /// cameras.
    [[nodiscard]] float focusDistance() const;
    /// Of a perspective image; none where rays are parallel.
    [[nodiscard]] std::optional<FieldOfView> fieldOfView() const;
    /// Every camera ray leaves the same point.
    [[nodiscard]] bool hasSinglePosition() const;
    /// None of other cameras.
    [[nodiscard]] const Detectors* detectors() const;
    /// position() says nothing about where a camera ray starts: all have the same direction, or there are detectors.
    [[nodiscard]] bool hasParallelRays() const;
};

/// camera-to-world from the scene's transform: negates the x axis.
Transform cameraTransform(const Transform& sceneTransform);

} // namespace tungsten
