#pragma once
// All surfaces of a scene in one Embree structure.

#include "tungsten/geometry/Embree.h"
#include "tungsten/geometry/Shape.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tungsten {

/// Closest intersection: which primitive, where, with its geometric and shading normals.
struct SurfaceHit {
    float t = Infinity;
    uint32_t shape = 0;   ///< index of the shape given to SceneGeometry
    uint32_t face = 0;    ///< triangle index (meshes)
    int32_t material = 0; ///< material index of the face, not yet clamped
    Vec3f position;
    Vec3f ng;         ///< geometric normal (by winding), unit; not flipped
    Vec3f ns;         ///< shading normal, unit; not flipped
    Vec3f dpdu, dpdv; ///< parametrisation tangents (for bump and anisotropy)
    Vec2f uv;
    float error = 0.0f; ///< of the margin

    [[nodiscard]] SurfaceMargin margin() const { return {ng, error}; }
    /// A ray on from here that does not meet the surface here, and does meet others that touch it here.
    [[nodiscard]] Ray leave(const Vec3f& direction) const { return {margin().off(position, direction), direction}; }
};

/// Owns the Embree scene over shapes that outlive it. Immutable; safe to query from many threads.
class SceneGeometry {
  public:
    /// `shapes` must stay alive and at the same address.
    explicit SceneGeometry(const std::vector<const Shape*>& shapes, const LoadWatch& watch = {});
    SceneGeometry(const SceneGeometry&) = delete;
    SceneGeometry& operator=(const SceneGeometry&) = delete;

    /// Closest hit in (tMin, tMax), or none.
    [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) const;
    /// Any hit in (tMin, tMax).
    [[nodiscard]] bool occluded(const Ray& ray) const;

    [[nodiscard]] Vec3f boundsMin() const { return boundsMin_; }
    [[nodiscard]] Vec3f boundsMax() const { return boundsMax_; }
    [[nodiscard]] size_t triangleCount() const { return triangleCount_; }

  private:
    void attachShapes(const LoadWatch& watch);

    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    std::vector<const Shape*> shapes_;
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    Vec3f boundsMin_{0, 0, 0}, boundsMax_{0, 0, 0};
    size_t triangleCount_ = 0;
};

} // namespace tungsten
