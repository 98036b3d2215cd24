#pragma once
// The part of a ray that lies in a spherical shell about a point, sampled by angle.

#include "tungsten/core/Types.h"

#include <array>

namespace tungsten::path {

/// Distances t in [0, tMax) along a ray for which low <= |x(t) - q| < high: at most two intervals. Drawn equiangularly
/// (Kulla and Fajardo 2012): density proportional to 1 / (h^2 + (t - c)^2), h the ray's distance from q and c where it
/// is nearest.
class ShellChord {
  public:
    /// `toCentre` = q - ray origin; `direction` unit.
    ShellChord(const Vec3f& toCentre, const Vec3f& direction, double low, double high, double tMax);

    [[nodiscard]] bool empty() const { return !(range_[0] + range_[1] > 0.0); }
    /// u in [0, 1) -> t.
    [[nodiscard]] double sample(double u) const;
    /// Density per length.
    [[nodiscard]] double pdf(double t) const;
    /// Where a sphere of this radius about q meets the ray beyond its origin and before tMax: up to two distances, and
    /// dt/dr there; the number of them.
    int intersect(double radius, std::array<double, 2>& t, std::array<double, 2>& perRadius) const;
    /// First and last distance of the chord.
    [[nodiscard]] double begin() const { return begin_; }
    [[nodiscard]] double end() const { return end_; }

  private:
    [[nodiscard]] double angleOf(double t) const { return std::atan((t - centre_) / spread_); }

    double centre_, squaredHeight_, spread_, tMax_;
    double begin_ = 0.0, end_ = 0.0;
    std::array<double, 2> angle_{}, range_{}; ///< of the two intervals: first angle, width
    std::array<std::array<double, 2>, 2> bounds_{};
};

} // namespace tungsten::path
