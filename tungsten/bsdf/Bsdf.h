#pragma once
// Surface scattering models: a closed set of plain structs, one file each (parameters, eval, pdf, sample).
//
// Directions are local to the shading frame (n = +z) and point away from the surface: wi toward the previous vertex of
// the walk, wo the sampled continuation. eval() includes |cos wo|. Values are for radiance transport unless the mode
// says photons (no (n_i/n_t)^2 across refractions).

#include "tungsten/texture/Texture.h"

#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace tungsten {

enum class TransportMode { Radiance, Photons };

/// What a lobe does; a set of them is a bit mask.
using LobeMask = unsigned;
namespace lobe {
inline constexpr LobeMask None = 0;
inline constexpr LobeMask DiffuseReflection = 1;
inline constexpr LobeMask GlossyReflection = 2;
inline constexpr LobeMask SpecularReflection = 4;
inline constexpr LobeMask GlossyTransmission = 8;
inline constexpr LobeMask SpecularTransmission = 16;
inline constexpr LobeMask Forward = 32; ///< straight through, index matched
inline constexpr LobeMask Smooth = DiffuseReflection | GlossyReflection | GlossyTransmission;
inline constexpr LobeMask Specular = SpecularReflection | SpecularTransmission;
inline constexpr LobeMask Transmissive = GlossyTransmission | SpecularTransmission;
inline constexpr LobeMask AnyTransmission = Transmissive | Forward; ///< all that brings light to the other side
inline constexpr LobeMask All = 63;
} // namespace lobe

struct BsdfQuery {
    Vec2f uv;
    TransportMode mode = TransportMode::Radiance;
    LobeMask requested = lobe::All; ///< lobes that sample, eval and pdf may use
};

struct BsdfSample {
    Vec3f wo;         ///< local
    Rgb weight;       ///< f |cos| / pdf for smooth lobes; weight / probability for specular and forward ones
    float pdf = 0.0f; ///< per solid angle for smooth lobes; discrete probability for specular and forward ones
    LobeMask lobe = lobe::None; ///< the one lobe that was sampled
};

/// Interface numbers a walk hands to sample: the uniforms for direction and for lobe choice.
struct BsdfRandom {
    Vec2f direction;
    float lobe;
};

class Bsdf;
using BsdfPtr = std::shared_ptr<const Bsdf>;

/// Isotropic microfacet distributions (docs/scene-format.md, section 8.2). The roughness is alpha.
enum class MicrofacetModel { Beckmann, Ggx, Phong, PbrtGgx };

struct Lambert {};
struct OrenNayar {
    Texture roughness{1.0f};
};
struct Mirror {};
struct Conductor {
    Rgb eta, k;
};
struct RoughConductor {
    Rgb eta, k;
    MicrofacetModel distribution = MicrofacetModel::Ggx;
    Texture roughness{0.1f};
};
struct Dielectric {
    float ior = 1.5f;
    bool enableRefraction = true;
};
struct RoughDielectric {
    float ior = 1.5f;
    MicrofacetModel distribution = MicrofacetModel::Ggx;
    Texture roughness{0.1f};
    bool enableRefraction = true;
};
struct Plastic {
    float ior = 1.5f;
    float thickness = 1.0f;
    Rgb sigmaA{0.0f};
    float diffuseFresnel = 0.0f; ///< 2 ∫ F(ior, c) c dc; set by makePlastic
};
struct RoughPlastic {
    float ior = 1.5f;
    float thickness = 1.0f;
    Rgb sigmaA{0.0f};
    MicrofacetModel distribution = MicrofacetModel::Ggx;
    Texture roughness{0.02f};
    Rgb ks{1.0f};
    float diffuseFresnel = 0.0f; ///< set by makeRoughPlastic
};
struct PbrtPlastic {
    float ior = 1.5f;
    MicrofacetModel distribution = MicrofacetModel::PbrtGgx;
    Texture roughness{0.1f};
    Rgb ks{0.25f};
};
struct Null {};
struct Forward {};
struct Transparency {
    BsdfPtr base;
    Texture alpha{1.0f};
};
struct Mixed {
    BsdfPtr bsdf0, bsdf1;
    Texture ratio{0.5f};
};

using BsdfModel = std::variant<Lambert, OrenNayar, Mirror, Conductor, RoughConductor, Dielectric, RoughDielectric,
                               Plastic, RoughPlastic, PbrtPlastic, Null, Forward, Transparency, Mixed>;

/// One named material: a model, its albedo and an optional bump map.
class Bsdf {
  public:
    std::string name;
    BsdfModel model;
    Texture albedo{1.0f};
    std::optional<Texture> bump;

    Bsdf() = default;
    Bsdf(std::string name_, BsdfModel model_, Texture albedo_ = Texture(1.0f));

    /// f |cos wo| of the smooth lobes in `query.requested`, per solid angle; specular and forward lobes are zero here.
    [[nodiscard]] Rgb eval(const BsdfQuery& query, const Vec3f& wi, const Vec3f& wo) const;
    /// Density of sample() per solid angle (smooth lobes only; includes the probability of choosing them).
    [[nodiscard]] float pdf(const BsdfQuery& query, const Vec3f& wi, const Vec3f& wo) const;
    /// Draws a continuation among the requested lobes; none when it absorbs.
    [[nodiscard]] std::optional<BsdfSample> sample(const BsdfQuery& query, const Vec3f& wi, const BsdfRandom& u) const;
    /// Weight of going straight through (forward: 1; transparency: 1 - alpha; mixed: the ratio of its parts,
    /// times the albedo; else 0).
    [[nodiscard]] Rgb forwardWeight(const Vec2f& uv) const;
    /// Every lobe the model can have.
    [[nodiscard]] LobeMask lobes() const { return lobes_; }

  private:
    LobeMask lobes_ = lobe::None;
};

/// Refractive index behind the normal over that before it; 1 where nothing is refracted.
float relativeIndex(const Bsdf& bsdf);

/// eta and k of the format's named metals; none for an unknown name.
std::optional<std::pair<Rgb, Rgb>> conductorByName(const std::string& name);
std::vector<std::string> conductorNames();

Plastic makePlastic(float ior, float thickness, const Rgb& sigmaA);
RoughPlastic makeRoughPlastic(float ior, float thickness, const Rgb& sigmaA, MicrofacetModel distribution,
                              Texture roughness, const Rgb& ks);

} // namespace tungsten
