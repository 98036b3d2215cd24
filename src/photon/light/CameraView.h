#pragma once
// What the camera can see: a distribution of directions into its image, and a test for points.

#include "photon/Tuning.h"
#include "photon/store/ArrivalCulling.h"

#include "darts/Vec3.h"

#include "tungsten/camera/Camera.h"

namespace tungsten::photon {

/// What pinhole and thin-lens cameras see.
class CameraView {
  public:
    explicit CameraView(const Camera& camera);

    /// False when no camera ray comes within `radius` of the point. Margins hold the pixel filter and the aperture.
    [[nodiscard]] bool sees(const Vec3f& point, float radius) const;
    /// The part of a ray whose points it sees: an interval, as what a pinhole sees is convex. A thin lens: all of it.
    [[nodiscard]] FlightPart seenPart(const Vec3f& origin, const Vec3f& direction, float radius) const;

    /// Outward unit normals of the planes through the position inside which points are seen.
    [[nodiscard]] std::array<Vec3f, 4> sides() const;

  private:
    Vec3f position_;
    Frame frame_;
    float marginX_, marginY_; ///< half the image's width and height at distance 1, with the filter's reach
    float slantX_, slantY_;   ///< sqrt(1 + margin^2): a sphere's reach beyond a slanted plane
    float aperture_ = 0.0f;
};

} // namespace tungsten::photon
