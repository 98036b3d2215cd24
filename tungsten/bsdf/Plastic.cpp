// A diffuse base under a dielectric coat: smooth, rough, and the sum of lobes that pbrt-v3 calls plastic.

#include "tungsten/bsdf/Fresnel.h"
#include "tungsten/bsdf/Microfacet.h"
#include "tungsten/bsdf/Models.h"

#include "tungsten/core/Warp.h"

namespace tungsten {

namespace {

/// Light that enters the coat, scatters in the base any number of times and leaves (value times |cos wo|).
template <typename Coat>
Rgb evalBase(const Coat& coat, const Rgb& albedo, const Vec3f& wi, const Vec3f& wo) {
    const float eta = 1.0f / coat.ior;
    const float through = (1.0f - fresnelDielectric(eta, wi.z)) * (1.0f - fresnelDielectric(eta, wo.z)) * eta * eta;
    Rgb value = albedo / (Rgb(1.0f) - albedo * coat.diffuseFresnel) * (through * InvPi * wo.z);
    if (!isBlack(coat.sigmaA))
        value = value * expNegative(coat.sigmaA * (coat.thickness * (1.0f / wi.z + 1.0f / wo.z)));
    return value;
}

/// Value of a microfacet reflection lobe with reflectance `fresnel`.
float evalGloss(const Microfacet& facets, float fresnel, const Vec3f& wi, const Vec3f& wo, const Vec3f& m) {
    return fresnel * facets.density(m) * facets.shadowing(wi, wo, m) / (4.0f * wi.z);
}

/// One-sample choice between a coat lobe of weight s and the base of weight d, among those requested.
float coatProbability(bool coat, bool base, float s, float d) {
    if (!coat || !base) return coat ? 1.0f : 0.0f;
    return s + d > 0.0f ? s / (s + d) : 0.5f;
}

bool facesUp(const Vec3f& wi, const Vec3f& wo) {
    return wi.z > 0.0f && wo.z > 0.0f;
}

/// Probability of the glossy lobe of either rough model, from its Fresnel weight at normal geometry.
template <typename Model>
float glossProbability(const Model& model, const ModelPoint& at, float fresnel) {
    return coatProbability(at.wants(lobe::GlossyReflection), at.wants(lobe::DiffuseReflection),
                           std::max(fresnel * maxComponent(model.ks), 0.05f),
                           maxComponent(at.albedo) * (1.0f - 0.5f * fresnel));
}

template <typename Model>
float pdfTwoLobes(const Model& model, const ModelPoint& at, float probability, const Vec3f& wi, const Vec3f& wo) {
    const Microfacet facets(model.distribution, model.roughness.scalar(at.query.uv));
    const Vec3f m = (wi + wo).normalized();
    const float base =
        at.wants(lobe::DiffuseReflection) ? (1.0f - probability) * warp::squareToCosineHemispherePdf(wo) : 0.0f;
    return probability * facets.pdf(wi, m) / (4.0f * std::abs(wi.dot(m))) + base;
}

template <typename Model>
MaybeSample sampleTwoLobes(const Model& model, const ModelPoint& at, float probability, const Vec3f& wi,
                           const BsdfRandom& u) {
    const bool gloss = u.lobe < probability;
    if (!gloss && !at.wants(lobe::DiffuseReflection)) return std::nullopt;
    const Microfacet facets(model.distribution, model.roughness.scalar(at.query.uv));
    const Vec3f wo =
        gloss ? reflectedAbout(wi, facets.sample(wi, u.direction)) : warp::squareToCosineHemisphere(u.direction);
    if (wo.z <= 0.0f) return std::nullopt;
    return smoothSample(model, at, wi, wo, gloss ? lobe::GlossyReflection : lobe::DiffuseReflection);
}

constexpr LobeMask RoughLobes = lobe::GlossyReflection | lobe::DiffuseReflection;

} // namespace

Plastic makePlastic(float ior, float thickness, const Rgb& sigmaA) {
    return {ior, thickness, sigmaA, averageFresnel(ior)};
}

RoughPlastic makeRoughPlastic(float ior, float thickness, const Rgb& sigmaA, MicrofacetModel distribution,
                              Texture roughness, const Rgb& ks) {
    return {ior, thickness, sigmaA, distribution, std::move(roughness), ks, averageFresnel(ior)};
}

template <>
LobeMask lobesOf(const Plastic&) {
    return lobe::SpecularReflection | lobe::DiffuseReflection;
}
template <>
Rgb evalModel(const Plastic& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (!facesUp(wi, wo) || !at.wants(lobe::DiffuseReflection)) return Rgb(0.0f);
    return evalBase(model, at.albedo, wi, wo);
}

namespace {
float mirrorProbability(const Plastic& model, const ModelPoint& at, const Vec3f& wi) {
    const float fresnel = fresnelDielectric(1.0f / model.ior, wi.z);
    return coatProbability(at.wants(lobe::SpecularReflection), at.wants(lobe::DiffuseReflection), fresnel,
                           maxComponent(at.albedo) * (1.0f - fresnel));
}
} // namespace

template <>
float pdfModel(const Plastic& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (!facesUp(wi, wo) || !at.wants(lobe::DiffuseReflection)) return 0.0f;
    return (1.0f - mirrorProbability(model, at, wi)) * warp::squareToCosineHemispherePdf(wo);
}
template <>
MaybeSample sampleModel(const Plastic& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) {
    if (wi.z <= 0.0f) return std::nullopt;
    const float probability = mirrorProbability(model, at, wi);
    if (u.lobe < probability) {
        const float fresnel = fresnelDielectric(1.0f / model.ior, wi.z);
        return BsdfSample{mirrored(wi), Rgb(fresnel / probability), probability, lobe::SpecularReflection};
    }
    return smoothSample(model, at, wi, warp::squareToCosineHemisphere(u.direction), lobe::DiffuseReflection);
}

template <>
LobeMask lobesOf(const RoughPlastic&) {
    return RoughLobes;
}
template <>
Rgb evalModel(const RoughPlastic& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (!facesUp(wi, wo)) return Rgb(0.0f);
    Rgb value(0.0f);
    if (at.wants(lobe::GlossyReflection)) {
        const Microfacet facets(model.distribution, model.roughness.scalar(at.query.uv));
        const Vec3f m = (wi + wo).normalized();
        value += model.ks * evalGloss(facets, fresnelDielectric(1.0f / model.ior, wi.dot(m)), wi, wo, m);
    }
    if (at.wants(lobe::DiffuseReflection)) value += evalBase(model, at.albedo, wi, wo);
    return value;
}
template <>
float pdfModel(const RoughPlastic& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (!facesUp(wi, wo)) return 0.0f;
    return pdfTwoLobes(model, at, glossProbability(model, at, fresnelDielectric(1.0f / model.ior, wi.z)), wi, wo);
}
template <>
MaybeSample sampleModel(const RoughPlastic& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) {
    if (wi.z <= 0.0f) return std::nullopt;
    return sampleTwoLobes(model, at, glossProbability(model, at, fresnelDielectric(1.0f / model.ior, wi.z)), wi, u);
}

// The coat's Fresnel term is taken from the inside (eta = ior), as pbrt-v3's plastic does: it is 1 beyond the critical
// angle.
template <>
LobeMask lobesOf(const PbrtPlastic&) {
    return RoughLobes;
}
template <>
Rgb evalModel(const PbrtPlastic& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (!facesUp(wi, wo)) return Rgb(0.0f);
    Rgb value(0.0f);
    if (at.wants(lobe::GlossyReflection)) {
        const Microfacet facets(model.distribution, model.roughness.scalar(at.query.uv));
        const Vec3f m = (wi + wo).normalized();
        value += model.ks * evalGloss(facets, fresnelDielectric(model.ior, wi.dot(m)), wi, wo, m);
    }
    if (at.wants(lobe::DiffuseReflection)) value += at.albedo * (InvPi * wo.z);
    return value;
}
template <>
float pdfModel(const PbrtPlastic& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (!facesUp(wi, wo)) return 0.0f;
    return pdfTwoLobes(model, at, glossProbability(model, at, fresnelDielectric(model.ior, wi.z)), wi, wo);
}
template <>
MaybeSample sampleModel(const PbrtPlastic& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) {
    if (wi.z <= 0.0f) return std::nullopt;
    return sampleTwoLobes(model, at, glossProbability(model, at, fresnelDielectric(model.ior, wi.z)), wi, u);
}

} // namespace tungsten
