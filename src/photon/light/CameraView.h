#pragma once
// What the camera can see: a distribution of directions into its image, and a test for points.

#include "photon/Tuning.h"
#include "photon/store/ArrivalCulling.h"

#include "darts/Vec3.h"

#include "tungsten/camera/Camera.h"

namespace tungsten::photon {

/// Of pinhole and thin-lens cameras. As a `View` of the sampling library: directions seen from the camera, mostly
/// uniform over the image plane, the rest uniform over the sphere, so that light behind the image's edge keeps a
/// density.
class CameraView {
  public:
    explicit CameraView(const Camera& camera);

    [[nodiscard]] darts::Vec3 sample(float u, float v) const;
    /// Per solid angle.
    [[nodiscard]] float pdf(const darts::Vec3& direction) const;
    /// False when no sensor ray comes within `radius` of the point. Margins hold the pixel filter and the aperture.
    [[nodiscard]] bool sees(const Vec3f& point, float radius) const;
    /// The part of a ray whose points it sees: an interval, as what a pinhole sees is convex. A thin lens: all of it.
    [[nodiscard]] FlightPart seenPart(const Vec3f& origin, const Vec3f& direction, float radius) const;

    /// Outward unit normals of the planes through the position inside which points are seen.
    [[nodiscard]] std::array<Vec3f, 4> sides() const;

  private:
    Vec3f position_;
    Frame frame_;
    float halfWidth_, halfHeight_; ///< of the image at distance 1, widened if narrow
    float marginX_, marginY_;      ///< of the same with the filter's reach
    float slantX_, slantY_;        ///< sqrt(1 + margin^2): a sphere's reach beyond a slanted plane
    float aperture_ = 0.0f;
};

} // namespace tungsten::photon
