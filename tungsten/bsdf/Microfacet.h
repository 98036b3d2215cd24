#pragma once
// Isotropic microfacet distributions and their sampling, in the local frame.

#include "tungsten/bsdf/BsdfModel.h"

namespace tungsten {

/// Isotropic microfacet distributions (docs/scene-format.md, section 8.2). The roughness is alpha.
enum class MicrofacetModel { Beckmann, Ggx, Phong, PbrtGgx };

/// Distribution of facet normals with its shadowing term. `roughness` is alpha; values below 1e-3 are raised to it.
class Microfacet {
  public:
    Microfacet(MicrofacetModel model, float roughness);

    /// D(m): facet area per unit area and solid angle.
    [[nodiscard]] float density(const Vec3f& m) const;
    /// G(wi, wo; m): separable, except height-correlated for pbrt-ggx.
    [[nodiscard]] float shadowing(const Vec3f& wi, const Vec3f& wo, const Vec3f& m) const;
    /// A facet normal: visible normals for the two GGX models (Heitz 2018), D cos for the others. wi.z > 0.
    [[nodiscard]] Vec3f sample(const Vec3f& wi, const Vec2f& u) const;
    /// Density of sample() per solid angle of m.
    [[nodiscard]] float pdf(const Vec3f& wi, const Vec3f& m) const;

  private:
    [[nodiscard]] float shadowingOne(const Vec3f& v, const Vec3f& m) const;
    [[nodiscard]] bool isGgx() const { return model_ == MicrofacetModel::Ggx || model_ == MicrofacetModel::PbrtGgx; }

    MicrofacetModel model_;
    float alpha_;    ///< roughness
    float exponent_; ///< of the Phong distribution
};

} // namespace tungsten
