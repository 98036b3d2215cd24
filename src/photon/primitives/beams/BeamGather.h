#pragma once
// Gathering photon beams along a camera segment with the one-dimensional kernel.

#include "photon/primitives/CameraSegment.h"
#include "photon/primitives/beams/Beams.h"
#include "photon/store/EmbreeScene.h"

#include <optional>

namespace tungsten::photon {

/// Where two lines come closest.
struct Approach {
    float alongBeam;   ///< s, from the beam's base
    float alongCamera; ///< t_c, from the camera segment's origin
    float offset;      ///< of the camera's point from the beam's, along beam x camera
    float sine;        ///< of the angle between the lines

    [[nodiscard]] float distance() const { return std::abs(offset); }
};
namespace detail {

template <typename Real>
std::optional<Approach> closestApproach(const Vec3f& base, const Vec3f& direction, const Vec3f& origin,
                                        const Vec3f& cameraDirection) {
    using Vector = Imath::Vec3<Real>;
    constexpr Real LeastSine = Real(1e-4);
    const Vector beam(direction), ray(cameraDirection), offset = Vector(base) - Vector(origin),
                                                        normal = beam.cross(ray);
    const Real squaredSine = normal.length2();
    if (!(squaredSine > LeastSine * LeastSine)) return std::nullopt;
    const Real sine = std::sqrt(squaredSine);
    return Approach{float(offset.cross(ray).dot(normal) / -squaredSine),
                    float(offset.cross(beam).dot(normal) / -squaredSine), float(-offset.dot(normal) / sine),
                    float(sine)};
}

} // namespace detail

/// None for lines that are parallel to 1e-4 (docs/photon-primitives.md, sections 2.2 and 5). Unit directions. In double
/// where they are nearly parallel: in floats the cross product would lose four digits, and the kernel's weight with it.
inline std::optional<Approach> closestApproach(const Vec3f& base, const Vec3f& direction, const Vec3f& origin,
                                               const Vec3f& cameraDirection) {
    constexpr float Oblique = 0.01f; // of the squared sine: floats keep six digits above
    return direction.cross(cameraDirection).length2() > Oblique
               ? detail::closestApproach<float>(base, direction, origin, cameraDirection)
               : detail::closestApproach<double>(base, direction, origin, cameraDirection);
}

/// Across a beam, of the ribbon that a camera ray sees: half-width r, without what the beam's edges cut off.
struct RibbonRange {
    float low, high;

    /// `along`: from the beam's base to the ribbon's place; `across`: unit, the ribbon's direction there.
    static RibbonRange of(const KernelEdges& edges, float along, const Vec3f& direction, const Vec3f& across,
                          float radius) {
        RibbonRange range{-radius, radius};
        for (const KernelEdge& edge : {edges.nearest, edges.opposite})
            if (edge.exists()) range.cut(edge.reach - along * edge.normal.dot(direction), edge.normal.dot(across));
        return range;
    }
    [[nodiscard]] bool holds(float distance) const { return distance >= low && distance < high; }
    [[nodiscard]] float width() const { return high - low; }

  private:
    /// Cuts the range by a plane at `height` from the beam. A beam that leaves a plane behind before the curved surface
    /// itself counts as lying on it.
    void cut(float height, float slope) {
        const float end = std::max(height, 0.0f) / std::max(std::abs(slope), 1e-6f);
        if (slope > 0.0f)
            high = std::min(high, end);
        else
            low = std::max(low, -end);
    }
};

class BeamGather {
  public:
    /// A part of one beam, [start, end) in distances from its base: long beams are cut, so that boxes stay small.
    struct Piece {
        uint32_t beam;
        float start, end;
    };

    /// `beams` must stay alive. `sensor` has the pass's gate: a delta gate's temporal kernel is a narrow box.
    /// `fewRays`: few segments will be asked for, so that beams stay whole, which builds faster (staircase, 100 000
    /// beams: 0.17 s instead of 0.28) and queries slower.
    BeamGather(const Scene& scene, const transport::TimeSensor& sensor, const std::vector<PhotonBeam>& beams,
               const Radii& radius, bool fewRays = false);

    /// Adds the sum over the beams near the segment of power sigma_s f_p T(s + t_c) / (2 radius sin), weighed by the
    /// sensor, to the frames they fall in (docs/photon-primitives.md, eq. 4). Returns how many were gathered.
    uint64_t gather(const CameraSegment& segment, FrameSums& sums) const;

  private:
    void cut(float mostPieces);

    const Scene& scene_;
    transport::TimeSensor sensor_;
    const std::vector<PhotonBeam>& beams_;
    Radii radii_;
    std::vector<Piece> pieces_; ///< by Embree's index
    /// Ray-facing ribbons of their half-width, exactly the support of the one-dimensional kernel; none without beams.
    std::optional<EmbreeScene> ribbons_;
    float largestRadius_ = 0.0f;
};

} // namespace tungsten::photon
