#pragma once
// Two images of the photons about a pinhole at the origin, by the point-beam kernel along the pixels' centre rays.

#include "darts/PhaseFunction.h"
#include "darts/Vec3.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace infinite_medium {

inline constexpr float ConeAngle = 21.0f * darts::Pi / 180.0f;

/// A volume photon: power already includes sigmaS and the density of its place.
struct Photon {
    darts::Vec3 position, direction; ///< direction: that it travels along
    float power = 0;
    int order = 1; ///< scatterings, the one at `position` included
};

enum class View {
    Cone,  ///< 24 x 24 pixels, square of 21 degrees to either side of the z axis
    Sphere ///< 24 columns of longitude by 12 rows of latitude about z
};

/// The pixels' rays, and which of them a photon's kernel meets.
class Image {
  public:
    Image(View view, float kernelRadius, float sigmaT, float g)
        : view_(view), columns_(24), rows_(view == View::Cone ? 24 : 12), radius_(kernelRadius), sigmaT_(sigmaT),
          g_(g) {
        for (int row = 0; row < rows_; ++row)
            for (int column = 0; column < columns_; ++column) rays_.push_back(ray(column, row));
    }
    [[nodiscard]] size_t size() const { return rays_.size(); }

    /// add(pixel, value) for every pixel whose ray passes within the kernel's radius: radiance, integrated over time.
    template <typename Add>
    void gather(const Photon& photon, Add&& add) const {
        const Range across = range(photon.position, true), down = range(photon.position, false);
        const darts::HenyeyGreenstein scatterer{photon.direction, g_};
        const float inverseRadius = 1.0f / radius_;
        for (int row = down.begin; row < down.end; ++row)
            for (int k = across.begin; k < across.end; ++k) {
                const size_t pixel = size_t(row * columns_ + (k % columns_ + columns_) % columns_);
                const float along = dot(photon.position, rays_[pixel]);
                const float distance = length(photon.position - along * rays_[pixel]) * inverseRadius;
                if (along <= 0 || distance >= 1) continue;
                const float support = (1 - distance * distance) * inverseRadius;
                const float kernel = 3.0f / darts::Pi * support * support; // 2-D biweight
                add(pixel, photon.power * kernel * scatterer.pdf(-rays_[pixel]) * std::exp(-sigmaT_ * along));
            }
    }

  private:
    struct Range {
        int begin = 0, end = 0;
    };

    [[nodiscard]] darts::Vec3 ray(int column, int row) const {
        const double u = (column + 0.5) / columns_, v = (row + 0.5) / rows_;
        if (view_ == View::Cone) {
            const double slope = std::tan(double(ConeAngle)), x = (2 * u - 1) * slope, y = (2 * v - 1) * slope;
            const double inverse = 1 / std::sqrt(x * x + y * y + 1);
            return {float(x * inverse), float(y * inverse), float(inverse)};
        }
        const double pi = 3.14159265358979323846, phi = (2 * u - 1) * pi, theta = v * pi;
        return {float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)), float(std::cos(theta))};
    }
    /// Columns or rows between the planes (cone) or cones (sphere) of constant image coordinate that touch the kernel's
    /// sphere. Columns of longitude may lie outside [0, columns): they count modulo columns.
    [[nodiscard]] Range range(const darts::Vec3& p, bool across) const {
        const int count = across ? columns_ : rows_;
        const float axial = view_ == View::Cone ? p.z : across ? p.x : p.z;
        const float lateral = view_ == View::Cone ? (across ? p.x : p.y) : across ? p.y : std::hypot(p.x, p.y);
        const float reach = std::hypot(axial, lateral);
        if (reach <= radius_) return {0, count};
        const float centre = std::atan2(lateral, axial), half = std::asin(radius_ / reach);
        const float low = coordinate(centre - half, across), high = coordinate(centre + half, across);
        const int begin = int(std::floor(low * float(count))), end = int(std::floor(high * float(count))) + 1;
        if (view_ == View::Sphere && across) return end - begin >= count ? Range{0, count} : Range{begin, end};
        return {std::clamp(begin, 0, count), std::clamp(end, 0, count)};
    }
    /// Of an angle, in [0, 1) inside the image.
    [[nodiscard]] float coordinate(float angle, bool across) const {
        if (view_ == View::Cone) {
            const float slope = std::tan(ConeAngle);
            if (angle >= 0.5f * darts::Pi) return 2.0f;
            if (angle <= -0.5f * darts::Pi) return -2.0f;
            return std::clamp(0.5f + 0.5f * std::tan(angle) / slope, -2.0f, 2.0f);
        }
        return across ? 0.5f + 0.5f * angle / darts::Pi : angle / darts::Pi;
    }

    View view_;
    int columns_, rows_;
    float radius_, sigmaT_, g_;
    std::vector<darts::Vec3> rays_;
};

} // namespace infinite_medium
