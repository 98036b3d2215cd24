#pragma once
// Phase functions: cosTheta between the directions of propagation before and after; g > 0 scatters forward.

#include "tungsten/core/Types.h"

#include <variant>

namespace tungsten {

struct Isotropic {
    [[nodiscard]] float eval(float cosTheta) const;
    [[nodiscard]] float sampleCosine(float u) const;
};
struct HenyeyGreenstein {
    float g = 0.0f;
    [[nodiscard]] float eval(float cosTheta) const;
    [[nodiscard]] float sampleCosine(float u) const;
};
struct Rayleigh {
    [[nodiscard]] float eval(float cosTheta) const;
    [[nodiscard]] float sampleCosine(float u) const;
};

/// Normalised over the sphere: eval is also the density per solid angle of sample.
class PhaseFunction {
  public:
    std::variant<Isotropic, HenyeyGreenstein, Rayleigh> model;

    [[nodiscard]] float eval(const Vec3f& before, const Vec3f& after) const;
    [[nodiscard]] float pdf(const Vec3f& before, const Vec3f& after) const { return eval(before, after); }
    [[nodiscard]] Vec3f sample(const Vec3f& before, const Vec2f& u) const;
    /// Mean cosine.
    [[nodiscard]] float g() const;
};

} // namespace tungsten
