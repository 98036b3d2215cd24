// A diffuse base under a dielectric coat: smooth, rough, and the sum of lobes that pbrt-v3 calls plastic.

#include "tungsten/bsdf/BsdfReader.h"
#include "tungsten/bsdf/Fresnel.h"
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

} // namespace

Plastic makePlastic(float ior, float thickness, const Rgb& sigmaA) {
    return {{}, ior, thickness, sigmaA, averageFresnel(ior)};
}

RoughPlastic makeRoughPlastic(float ior, float thickness, const Rgb& sigmaA, MicrofacetModel distribution,
                              Texture roughness, const Rgb& ks) {
    return {{}, ior, thickness, sigmaA, distribution, std::move(roughness), ks, averageFresnel(ior)};
}

Rgb Plastic::eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (!facesUp(wi, wo) || !at.wants(lobe::DiffuseReflection)) return Rgb(0.0f);
    return evalBase(*this, at.albedo, wi, wo);
}

float Plastic::mirrorProbability(const ModelPoint& at, const Vec3f& wi) const {
    const float fresnel = fresnelDielectric(1.0f / ior, wi.z);
    return coatProbability(at.wants(lobe::SpecularReflection), at.wants(lobe::DiffuseReflection), fresnel,
                           maxComponent(at.albedo) * (1.0f - fresnel));
}

float Plastic::pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (!facesUp(wi, wo) || !at.wants(lobe::DiffuseReflection)) return 0.0f;
    return (1.0f - mirrorProbability(at, wi)) * warp::squareToCosineHemispherePdf(wo);
}
MaybeSample Plastic::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    if (wi.z <= 0.0f) return std::nullopt;
    const float probability = mirrorProbability(at, wi);
    if (u.lobe < probability) {
        const float fresnel = fresnelDielectric(1.0f / ior, wi.z);
        return BsdfSample{mirrored(wi), Rgb(fresnel / probability), probability, lobe::SpecularReflection};
    }
    return smoothSample(*this, at, wi, warp::squareToCosineHemisphere(u.direction), lobe::DiffuseReflection);
}

Rgb RoughPlastic::eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (!facesUp(wi, wo)) return Rgb(0.0f);
    Rgb value(0.0f);
    if (at.wants(lobe::GlossyReflection)) {
        const Microfacet facets(distribution, roughness.scalar(at.query.uv));
        const Vec3f m = (wi + wo).normalized();
        value += ks * evalGloss(facets, fresnelDielectric(1.0f / ior, wi.dot(m)), wi, wo, m);
    }
    if (at.wants(lobe::DiffuseReflection)) value += evalBase(*this, at.albedo, wi, wo);
    return value;
}
float RoughPlastic::pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (!facesUp(wi, wo)) return 0.0f;
    return pdfTwoLobes(*this, at, glossProbability(*this, at, fresnelDielectric(1.0f / ior, wi.z)), wi, wo);
}
MaybeSample RoughPlastic::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    if (wi.z <= 0.0f) return std::nullopt;
    return sampleTwoLobes(*this, at, glossProbability(*this, at, fresnelDielectric(1.0f / ior, wi.z)), wi, u);
}

Rgb PbrtPlastic::eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (!facesUp(wi, wo)) return Rgb(0.0f);
    Rgb value(0.0f);
    if (at.wants(lobe::GlossyReflection)) {
        const Microfacet facets(distribution, roughness.scalar(at.query.uv));
        const Vec3f m = (wi + wo).normalized();
        value += ks * evalGloss(facets, fresnelDielectric(ior, wi.dot(m)), wi, wo, m);
    }
    if (at.wants(lobe::DiffuseReflection)) value += at.albedo * (InvPi * wo.z);
    return value;
}
float PbrtPlastic::pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (!facesUp(wi, wo)) return 0.0f;
    return pdfTwoLobes(*this, at, glossProbability(*this, at, fresnelDielectric(ior, wi.z)), wi, wo);
}
MaybeSample PbrtPlastic::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    if (wi.z <= 0.0f) return std::nullopt;
    return sampleTwoLobes(*this, at, glossProbability(*this, at, fresnelDielectric(ior, wi.z)), wi, u);
}

namespace {

float readThickness(const BsdfReader& fields) {
    return float(fields.number("thickness", 1.0, {"length", "of the coat, for absorption"}, Range::nonNegative()));
}

Rgb readCoatAbsorption(const BsdfReader& fields) {
    return fields.rgb("sigma_a", Rgb(0.0f), {"1/length", "absorption in the coat"}, Range::nonNegative());
}

Rgb readSpecularFactor(const BsdfReader& fields, float fallback) {
    return fields.rgb("Ks", Rgb(fallback), {"none", "factor on what the coat reflects"}, Range::nonNegative());
}

} // namespace

Plastic Plastic::read(const BsdfReader& fields) {
    const Rgb sigmaA = readCoatAbsorption(fields);
    const float thickness = readThickness(fields);
    return makePlastic(fields.ior(), thickness, sigmaA);
}

RoughPlastic RoughPlastic::read(const BsdfReader& fields) {
    RoughPlastic coat;
    coat.ks = readSpecularFactor(fields, 1.0f);
    coat.roughness = fields.roughness(0.02f);
    coat.distribution = fields.distribution(MicrofacetModel::Ggx);
    coat.sigmaA = readCoatAbsorption(fields);
    coat.thickness = readThickness(fields);
    coat.ior = fields.ior();
    coat.diffuseFresnel = averageFresnel(coat.ior);
    return coat;
}

PbrtPlastic PbrtPlastic::read(const BsdfReader& fields) {
    return {{},
            fields.ior(),
            fields.distribution(MicrofacetModel::PbrtGgx),
            fields.roughness(0.1f),
            readSpecularFactor(fields, 0.25f)};
}

} // namespace tungsten
