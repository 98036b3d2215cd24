#pragma once
// Surface scattering: the set of models, and a material made of one.

#include "tungsten/bsdf/Conductor.h"
#include "tungsten/bsdf/Dielectric.h"
#include "tungsten/bsdf/Diffuse.h"
#include "tungsten/bsdf/Passage.h"
#include "tungsten/bsdf/Plastic.h"

namespace tungsten {

using Bsdfs = BsdfSet<Lambert, OrenNayar, Mirror, Conductor, RoughConductor, Dielectric, RoughDielectric, Plastic,
                      RoughPlastic, PbrtPlastic, Null, Forward, Transparency, Mixed>;

/// One named material: a model, its albedo and an optional bump map.
class Bsdf {
  public:
    std::string name;
    Bsdfs::Variant model;
    Texture albedo{1.0f};
    std::optional<Texture> bump;

    Bsdf() = default;
    Bsdf(std::string name_, Bsdfs::Variant model_, Texture albedo_ = Texture(1.0f));

    /// f |cos wo| of the smooth lobes in `query.requested`, per solid angle; specular and forward lobes are zero here.
    [[nodiscard]] Rgb eval(const BsdfQuery& query, const Vec3f& wi, const Vec3f& wo) const;
    /// Density of sample() per solid angle (smooth lobes only; includes the probability of choosing them).
    [[nodiscard]] float pdf(const BsdfQuery& query, const Vec3f& wi, const Vec3f& wo) const;
    /// Draws a continuation among the requested lobes; none when it absorbs.
    [[nodiscard]] MaybeSample sample(const BsdfQuery& query, const Vec3f& wi, const BsdfRandom& u) const;
    /// Weight of going straight through (forward: 1; transparency: 1 - alpha; mixed: the ratio of its parts,
    /// times the albedo; else 0).
    [[nodiscard]] Rgb forwardWeight(const Vec2f& uv) const;
    /// Every lobe the model can have.
    [[nodiscard]] LobeMask lobes() const { return lobes_; }
    /// Refractive index behind the normal over that before it; 1 where nothing is refracted.
    [[nodiscard]] float relativeIndex() const;
    /// Whether f, straight passage aside, is one value for all directions on the side that light comes from, and 0 on
    /// the other: then it is known before a direction is. Models that are so at some parameters alone count as uneven.
    [[nodiscard]] bool isLambertian() const;
    [[nodiscard]] BsdfParts parts() const;

  private:
    LobeMask lobes_ = lobe::None;
};

} // namespace tungsten
