#pragma once
// All surfaces of a scene in one Embree structure.

#include "tungsten/geometry/CoincidentFaces.h"
#include "tungsten/geometry/Embree.h"
#include "tungsten/geometry/Shape.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tungsten {

/// Closest intersection: which primitive, where, with its geometric and shading normals.
struct SurfaceHit {
    float t = Infinity;
    uint32_t shape = 0;   ///< index of the shape given to SceneGeometry
    uint32_t face = 0;    ///< triangle index (meshes)
    int32_t material = 0; ///< material index of the face, not yet clamped
    Vec3f position;
    Vec3f ng; ///< geometric normal (by winding), unit; not flipped
    Vec3f ns; ///< shading normal, unit; not flipped
    Vec2f uv;
    float error = 0.0f; ///< of the margin

    [[nodiscard]] FaceIndex index() const { return {shape, face}; }
    [[nodiscard]] SurfaceMargin margin() const { return {ng, error, index()}; }
    /// A ray on from here that does not meet the surface here, and does meet others that touch it here.
    [[nodiscard]] Ray spawnRay(const Vec3f& direction) const {
        return {margin().off(position, direction), direction, 0.0f, Infinity, index()};
    }
    /// The rest of the ray that met it, up to the same end; lengths along it count from here.
    [[nodiscard]] Ray rest(const Ray& ray) const {
        Ray onward = spawnRay(ray.direction);
        if (!(ray.tMax < Infinity)) return onward;
        // It starts beside the ray, by some of the margin: from there to the same point, else it would meet what the
        // ray ends short of.
        const Vec3d left = Vec3d(ray.origin) + Vec3d(ray.direction) * double(ray.tMax) - Vec3d(onward.origin);
        const double length = left.length();
        if (!(length > 0.0) || left.dot(Vec3d(ray.direction)) <= 0.0) {
            onward.tMax = 0.0f;
        } else {
            onward.direction = Vec3f(left / length);
            onward.tMax = float(length);
        }
        return onward;
    }
};

/// Owns the Embree scene over shapes that outlive it. Immutable; safe to query from many threads.
class SceneGeometry {
  public:
    /// `shapes` must stay alive and at the same address; `opaque` as CoincidentFaces has it.
    explicit SceneGeometry(const std::vector<const Shape*>& shapes, const std::vector<bool>& opaque = {},
                           const LoadWatch& watch = {});
    SceneGeometry(const SceneGeometry&) = delete;
    SceneGeometry& operator=(const SceneGeometry&) = delete;

    /// Closest hit in (tMin, tMax), or none. Faces at one place are met one after the other, in the order of
    /// CoincidentFaces, also from the face that the ray leaves.
    [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) const;
    /// Any hit in (tMin, tMax).
    [[nodiscard]] bool occluded(const Ray& ray) const;
    /// From `position` to the nearest point of any surface, if one is nearer than `radius`.
    [[nodiscard]] std::optional<Vec3d> toNearest(const Vec3f& position, float radius) const;
    /// The same, of these faces alone, and the face: of those as near as each other the first.
    struct NearestPoint {
        Vec3d offset;
        FaceIndex face;
    };
    [[nodiscard]] std::optional<NearestPoint> toNearest(const Vec3f& position, float radius,
                                                        std::span<const FaceIndex> faces) const;
    /// All faces with a point nearer than `radius`, in any order; none where there are more than `most`.
    [[nodiscard]] std::optional<std::vector<FaceIndex>> facesWithin(const Vec3f& position, float radius,
                                                                    size_t most) const;
    /// The plane of a face that is flat: a point and the unit normal.
    struct Plane {
        Vec3d point, normal;
    };
    [[nodiscard]] std::optional<Plane> planeOf(const FaceIndex& face) const;
    /// At a point that a ray has met; any two across the normal where the surface has no coordinates.
    [[nodiscard]] Tangents tangents(const SurfaceHit& hit) const;

    [[nodiscard]] Vec3f boundsMin() const { return boundsMin_; }
    [[nodiscard]] Vec3f boundsMax() const { return boundsMax_; }
    [[nodiscard]] size_t triangleCount() const { return triangleCount_; }

  private:
    void attachShapes(const LoadWatch& watch);
    /// Everything of `hit` but shape, face and t.
    void complete(const Ray& ray, const Vec2f& barycentric, SurfaceHit& hit) const;
    [[nodiscard]] bool leavesCoincident(const Ray& ray) const {
        return coincident_.any() && ray.leaves.isSet() && coincident_.reach(ray.leaves) > 0.0f;
    }
    /// Of all at the place that the ray met, the one that comes first.
    void takeFirst(const Ray& ray, SurfaceHit& hit) const;
    /// The next at the place that the ray leaves; then what lies beyond.
    [[nodiscard]] std::optional<SurfaceHit> intersectFromCoincident(Ray ray) const;

    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    std::vector<const Shape*> shapes_;
    CoincidentFaces coincident_;
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    Vec3f boundsMin_{0, 0, 0}, boundsMax_{0, 0, 0};
    size_t triangleCount_ = 0;
};

} // namespace tungsten
