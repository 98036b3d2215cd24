#pragma once
// Pixel filters, sampled: offsets are drawn from |filter| and every sample has weight 1 (docs/scene-format.md,
// section 3.1).

#include "tungsten/core/Distribution.h"

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace tungsten {

enum class FilterType { Dirac, Box, Tent, Gaussian, MitchellNetravali, CatmullRom, Lanczos };

class ReconstructionFilter {
  public:
    explicit ReconstructionFilter(FilterType type = FilterType::Tent);
    /// Offset from the pixel centre, in pixels.
    [[nodiscard]] Vec2f sample(const Vec2f& u) const;
    /// Density of sample() along one axis, per pixel; an image is the mean over offsets drawn from the product of both.
    [[nodiscard]] float pdf(float offset) const;
    /// Offsets have no larger magnitude.
    [[nodiscard]] float reach() const;
    /// Unnormalised one-dimensional profile.
    [[nodiscard]] float eval(float x) const;
    [[nodiscard]] float halfWidth() const;
    [[nodiscard]] FilterType type() const { return type_; }

  private:
    FilterType type_;
    Distribution1D bins_; ///< the format's 31 bins per half axis
};

std::optional<FilterType> filterByName(const std::string& name);
std::vector<std::string> filterNames();

} // namespace tungsten
