#pragma once
// One face of a sealed body, seen from a vertex behind it: the ways through it to an emitter (docs/method.md, section
// 10.5).

#include "path/techniques/ArrivalCandidates.h"

#include "transport/BoundedMedium.h"

#include "tungsten/core/Overloaded.h"
#include "tungsten/core/Types.h"
#include "tungsten/geometry/AnalyticShape.h"

#include <optional>

namespace tungsten::path {

/// The way out of a body through a plane boundary that refracts.
/// From a point at `depth` behind a plane to one at `height` before it. Angles are to the normal.
struct RefractedPath {
    float depth, height;
    float cosInside, cosOutside;

    /// Lengths of the two straight parts.
    [[nodiscard]] float inside() const { return depth / cosInside; }
    [[nodiscard]] float outside() const { return height / cosOutside; }
    /// Area at its end, on a plane parallel to the boundary, over the solid angle at its start. `index`: inside over
    /// outside.
    [[nodiscard]] float areaPerSolidAngle(float index) const;
};

/// The one way whose ends are `lateral` apart along the plane; none if `depth` or `height` is not above 0, or where
/// rounding leaves no angle. `index`: refractive index inside over outside.
std::optional<RefractedPath> refractedPath(float depth, float height, float lateral, float index);

/// Beyond the plane of a unit normal, outward; `direction` leads out. None under total internal reflection.
std::optional<Vec3f> refractedOut(const Vec3f& direction, const Vec3f& normal, float index);

/// An emitter with an area whose points draw() finds by their directions: no two of one direction send light there.
struct RefractedEmitter {
    /// A candidate.
    struct Point {
        SurfaceSample at;
        [[nodiscard]] Vec3f position() const { return at.position; }
        [[nodiscard]] static float length() { return 0.0f; }
    };
    static bool isOne(const Emitter& emitter);

    const Emitter* emitter;
    int index;
    float speed; ///< of light about it
    BoundingSphere bounds;
    ArrivalCandidates<Point> points; ///< of the pass

    [[nodiscard]] const AreaEmitter& area() const { return std::get<AreaEmitter>(emitter->model); }
    /// Calls `visit(point, normal)` for all of its points that a ray meets and that send light back along it.
    template <typename Visit>
    void eachOn(const Vec3f& origin, const Vec3f& direction, Visit&& visit) const;
};

/// One face of a body from a vertex behind it, towards one emitter: as if nothing else were between them.
struct RefractedView {
    /// A way to a point of the emitter.
    struct RefractedTarget {
        RefractedPath way;
        Vec3f direction; ///< at the vertex, unit
        float time;      ///< of flight
        float density;   ///< of directions to points of the emitter that are drawn uniformly, per solid angle
    };
    Vec3f position, foot, normal; ///< foot: the point of the face's plane nearest to the vertex
    float depth, index, speedInside;
    const RefractedEmitter& lamp;
    float leastCosine, widest; ///< ways beyond the angle inside are left out; the greatest shift along the plane

    RefractedView(const Vec3f& vertex, const transport::BoundedMedium::Face& face, float relativeIndex, float speed,
                  const RefractedEmitter& emitter);
    /// Direction in which the way to a point starts, whether or not there is light.
    [[nodiscard]] std::optional<Vec3f> directionTo(const Vec3f& point) const;
    [[nodiscard]] std::optional<RefractedTarget> towards(const Vec3f& point, const Vec3f& normalThere) const;
    /// Visits all points that `direction` leads to.
    template <typename Visit>
    void eachAlong(const Vec3f& direction, Visit&& visit) const;

  private:
    struct Course {
        RefractedPath way;
        Vec3f direction, outward; ///< at its start and end, unit
    };
    [[nodiscard]] std::optional<Course> courseTo(const Vec3f& point) const;
    [[nodiscard]] std::optional<RefractedTarget> aim(const RefractedPath& way, const Vec3f& direction,
                                                     const Vec3f& outward, const Vec3f& normalThere) const;
};

/// The length at which a ray meets a triangle's front, or a negative number.
float meetsFront(const TriangleMesh& mesh, const Triangle& triangle, const Vec3f& origin, const Vec3f& direction);

template <typename Visit>
void RefractedEmitter::eachOn(const Vec3f& origin, const Vec3f& direction, Visit&& visit) const {
    const auto single = [&](const auto& shape, const auto& normalAt) {
        const float t = intersectShape(shape, origin, direction, 0.0f, Infinity);
        if (t > 0.0f) visit(origin + direction * t, normalAt(origin + direction * t));
    };
    std::visit(Overloaded{[&](const TriangleMesh& mesh) {
                              for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
                                  const float t = meetsFront(mesh, mesh.triangles[i], origin, direction);
                                  if (t > 0.0f) visit(origin + direction * t, mesh.faceNormal(i));
                              }
                          },
                          [&](const Sphere& sphere) {
                              single(sphere, [&](const Vec3f& at) { return (at - sphere.centre).normalized(); });
                          },
                          [&](const Disk& disk) { single(disk, [&](const Vec3f&) { return disk.frame.n; }); }},
               *area().shape);
}

template <typename Visit>
void RefractedView::eachAlong(const Vec3f& direction, Visit&& visit) const {
    const auto outward = refractedOut(direction, normal, index);
    if (!outward) return;
    const float cosine = direction.dot(normal);
    const Vec3f exit = position + direction * (depth / cosine);
    lamp.eachOn(exit, *outward, [&](const Vec3f& point, const Vec3f& normalThere) {
        const RefractedPath way{depth, (point - exit).dot(normal), cosine, outward->dot(normal)};
        if (const auto found = aim(way, direction, *outward, normalThere)) visit(*found);
    });
}

} // namespace tungsten::path
