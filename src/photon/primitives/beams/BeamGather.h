#pragma once
// Gathering photon beams along a camera segment with the one-dimensional kernel.

#include "photon/primitives/Radii.h"
#include "photon/primitives/beams/EmbreeBeams.h"
#include "photon/view/CameraSegment.h"

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

class BeamGather {
  public:
    /// `beams` must stay alive. `sensor` has the pass's gate: a delta gate's temporal kernel is a narrow box.
    /// `fewRays`: few segments will be asked for.
    BeamGather(const Scene& scene, const transport::TimeSensor& sensor, const std::vector<PhotonBeam>& beams,
               const Radii& radius, bool fewRays = false);

    /// Adds the sum over the beams near the segment of power sigma_s f_p T(s + t_c) / (2 radius sin), weighed by the
    /// sensor, to the frames they fall in (docs/photon-primitives.md, eq. 4). Returns how many were gathered.
    uint64_t gather(const CameraSegment& segment, FrameSums& sums) const;

  private:
    const Scene& scene_;
    transport::TimeSensor sensor_;
    const std::vector<PhotonBeam>& beams_;
    Radii radii_;
    EmbreeBeams structure_;
};

} // namespace tungsten::photon
