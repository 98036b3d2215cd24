#pragma once
// An Embree structure over points with radii, owned.

#include "tungsten/core/Types.h"

#include <embree3/rtcore.h>

#include <vector>

namespace tungsten::photon {

/// Position and radius, as Embree lays points out.
struct PointWithRadius {
    Vec3f position;
    float radius;
};

/// What the points are for: rays that meet ray-facing discs (RTC_GEOMETRY_TYPE_DISC_POINT, exactly the support of the
/// two-dimensional point-beam kernel), or point queries, which Embree answers for user geometry but not for discs.
enum class PointUse { Rays, PointQueries };

class EmbreePoints {
  public:
    EmbreePoints(std::vector<PointWithRadius> points, PointUse use);
    ~EmbreePoints();
    EmbreePoints(const EmbreePoints&) = delete;
    EmbreePoints& operator=(const EmbreePoints&) = delete;
    [[nodiscard]] RTCScene scene() const { return scene_; }
    [[nodiscard]] float largestRadius() const { return largestRadius_; }

  private:
    std::vector<PointWithRadius> points_; ///< what user geometry's bounds are read from; empty for discs
    RTCDevice device_;
    RTCScene scene_;
    float largestRadius_ = 0.0f;
};

} // namespace tungsten::photon
