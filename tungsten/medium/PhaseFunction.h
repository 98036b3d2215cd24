#pragma once
// Phase functions; g > 0 scatters forward.

#include "tungsten/core/Types.h"

#include <variant>

namespace tungsten {

// Models are functions of h = 1 - cos of the angle between the direction after and the peak: the direction of
// propagation before, or its opposite where more is scattered back than forward. About a peak that is narrow nothing
// cancels in h, as it does in the cosine.

struct Isotropic {
    [[nodiscard]] float eval(float h) const;
    [[nodiscard]] float sample(float u) const;
    [[nodiscard]] float meanCosine() const { return 0.0f; }
    [[nodiscard]] bool evenly() const { return true; } ///< no direction is preferred
    static constexpr bool OfHenyeyGreenstein = true;   ///< at a mean cosine of 0
};
struct HenyeyGreenstein {
    float g = 0.0f;
    [[nodiscard]] float eval(float h) const;
    [[nodiscard]] float sample(float u) const;
    [[nodiscard]] float meanCosine() const { return g; }
    [[nodiscard]] bool evenly() const { return g == 0.0f; }
    static constexpr bool OfHenyeyGreenstein = true;
};
struct Rayleigh {
    [[nodiscard]] float eval(float h) const;
    [[nodiscard]] float sample(float u) const;
    [[nodiscard]] float meanCosine() const { return 0.0f; }
    [[nodiscard]] bool evenly() const { return false; }
    static constexpr bool OfHenyeyGreenstein = false;
};

/// Normalised over the sphere: eval is also the density per solid angle of sample.
class PhaseFunction {
  public:
    std::variant<Isotropic, HenyeyGreenstein, Rayleigh> model;

    [[nodiscard]] float eval(const Vec3f& before, const Vec3f& after) const;
    [[nodiscard]] float pdf(const Vec3f& before, const Vec3f& after) const { return eval(before, after); }
    [[nodiscard]] Vec3f sample(const Vec3f& before, const Vec2f& u) const;
    /// Mean cosine.
    [[nodiscard]] float g() const {
        return std::visit([](const auto& phase) { return phase.meanCosine(); }, model);
    }
    [[nodiscard]] bool isIsotropic() const {
        return std::visit([](const auto& phase) { return phase.evenly(); }, model);
    }
    /// Its values are those of Henyey and Greenstein's at g().
    [[nodiscard]] bool isHenyeyGreenstein() const {
        return std::visit([](const auto& phase) { return phase.OfHenyeyGreenstein; }, model);
    }

  private:
    [[nodiscard]] Vec3f peak(const Vec3f& before) const { return g() < 0.0f ? -before : before; }
};

} // namespace tungsten
