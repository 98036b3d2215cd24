#pragma once
// An Embree structure over points with radii, owned.

#include "photon/store/Store.h"

#include "tungsten/geometry/Embree.h"

#include <vector>

namespace tungsten::photon {

/// Position and radius, as Embree lays points out.
struct PointWithRadius {
    Vec3f position;
    float radius;
};

class EmbreePoints {
  public:
    /// For rays: ray-facing discs (RTC_GEOMETRY_TYPE_DISC_POINT), exactly the support of the two-dimensional point-beam
    /// kernel.
    explicit EmbreePoints(const std::vector<PointWithRadius>& discs);
    /// For point queries, which Embree answers for user geometry but not for discs. `photons` must stay alive.
    explicit EmbreePoints(const std::vector<Photon>& photons);
    ~EmbreePoints();
    EmbreePoints(const EmbreePoints&) = delete;
    EmbreePoints& operator=(const EmbreePoints&) = delete;
    [[nodiscard]] RTCScene scene() const { return scene_; }
    [[nodiscard]] float largestRadius() const { return largestRadius_; }

  private:
    void commit(RTCGeometry geometry);

    RTCDevice device_;
    RTCScene scene_;
    float largestRadius_ = 0.0f;
};

} // namespace tungsten::photon
