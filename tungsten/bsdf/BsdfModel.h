#pragma once
// What a surface scattering model answers: a plain struct with its parameters, in a file of its own.
//
// Directions are local to the shading frame (n = +z) and point away from the surface: wi toward the previous vertex of
// the walk, wo the sampled continuation. eval() includes |cos wo|. Values are for radiance transport unless the mode
// says photons (no (n_i/n_t)^2 across refractions). Reflective models are black from behind (wi.z <= 0): the caller
// flips the frame for two-sided shading.

#include "tungsten/core/ModelSet.h"
#include "tungsten/texture/Texture.h"

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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
using MaybeSample = std::optional<BsdfSample>;

/// Interface numbers a walk hands to sample: the uniforms for direction and for lobe choice.
struct BsdfRandom {
    Vec2f direction;
    float lobe;
};

/// Where a model is evaluated.
struct ModelPoint {
    const BsdfQuery& query;
    Rgb albedo;

    [[nodiscard]] bool wants(LobeMask lobes) const { return (query.requested & lobes) != 0; }
};

class Bsdf;
using BsdfPtr = std::shared_ptr<const Bsdf>;
class BsdfReader;

/// What a model is made of besides numbers.
struct BsdfParts {
    std::vector<Texture> textures;
    std::vector<BsdfPtr> bsdfs;
};

template <typename M>
concept BsdfModel = std::copyable<M> &&
    requires(const M& m, const ModelPoint& at, const Vec3f& w, const BsdfRandom& u) {
    { M::Type } -> std::convertible_to<std::string>;     // of the scene file
    &M::read;                                            // from a BsdfReader: it, or a variant of it and a simpler one
    { m.lobes() } -> std::same_as<LobeMask>;             // every lobe it can have
    { m.eval(at, w, w) } -> std::same_as<Rgb>;           // f |cos wo| of its smooth lobes in at.query.requested
    { m.pdf(at, w, w) } -> std::same_as<float>;          // of sample(), per solid angle (smooth lobes)
    { m.sample(at, w, u) } -> std::same_as<MaybeSample>; // one continuation among the requested lobes
    { m.forwardWeight(at) } -> std::same_as<Rgb>;        // what sample() brings straight through on average
    { m.relativeIndex() } -> std::same_as<float>;        // behind the normal over before it; 1: nothing is refracted
    { m.isLambertian() } -> std::same_as<bool>;          // whatever its parameters: see Bsdf
    { m.parts() } -> std::same_as<BsdfParts>;
};

template <BsdfModel M>
using CheckedBsdf = M;
template <typename... M>
using BsdfSet = ModelSet<CheckedBsdf<M>...>;

/// What most models answer alike: nothing goes straight through, nothing is refracted, all there is are numbers.
struct BsdfBase {
    [[nodiscard]] Rgb forwardWeight(const ModelPoint&) const { return Rgb(0.0f); }
    [[nodiscard]] float relativeIndex() const { return 1.0f; }
    [[nodiscard]] bool isLambertian() const { return false; }
    [[nodiscard]] BsdfParts parts() const { return {}; }
};
/// The same, of models without smooth lobes.
struct SpecularBase : BsdfBase {
    [[nodiscard]] Rgb eval(const ModelPoint&, const Vec3f&, const Vec3f&) const { return Rgb(0.0f); }
    [[nodiscard]] float pdf(const ModelPoint&, const Vec3f&, const Vec3f&) const { return 0.0f; }
};

/// Finishes a sample of smooth lobes: weight eval / pdf of the whole model.
template <typename Model>
MaybeSample smoothSample(const Model& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo, LobeMask lobe) {
    const float pdf = model.pdf(at, wi, wo);
    if (!(pdf > 0.0f)) return std::nullopt;
    return BsdfSample{wo, model.eval(at, wi, wo) / pdf, pdf, lobe};
}

inline Vec3f mirrored(const Vec3f& wi) {
    return {-wi.x, -wi.y, wi.z};
}
inline Vec3f reflectedAbout(const Vec3f& wi, const Vec3f& m) {
    return m * (2.0f * wi.dot(m)) - wi;
}

} // namespace tungsten
