#pragma once
// Cameras: the set of models, and one of them where it stands.

#include "tungsten/camera/Detectors.h"
#include "tungsten/camera/Orthographic.h"
#include "tungsten/camera/Perspective.h"
#include "tungsten/camera/ReconstructionFilter.h"

namespace tungsten {

using Cameras = CameraSet<Pinhole, ThinLens, Orthographic, Detectors>;

class Camera : public CameraPlacement {
  public:
    Cameras::Variant model;
    ReconstructionFilter filter;

    /// Ray through raster position `pixel` + 0.5 + filter offset; weight 1. `uLens` is used by the thin lens and
    /// detectors; to detectors `uFilter` is the direction.
    [[nodiscard]] Ray generateRay(const Vec2i& pixel, const Vec2f& uFilter, const Vec2f& uLens) const;
    /// The ray of generateRay that meets `point` after leaving the lens where `uLens` says; none behind the camera. The
    /// raster position may lie outside the image.
    [[nodiscard]] MaybeSensor sampleSensor(const Vec3f& point, const Vec2f& uLens) const;
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
    [[nodiscard]] const Detectors* detectors() const { return std::get_if<Detectors>(&model); }
    /// position() says nothing about where a camera ray starts: all have the same direction, or there are detectors.
    [[nodiscard]] bool hasParallelRays() const;
};

/// camera-to-world from the scene's transform: negates the x axis.
Transform cameraTransform(const Transform& sceneTransform);

} // namespace tungsten
