// Lambert and Oren-Nayar.

#include "tungsten/bsdf/BsdfReader.h"
#include "tungsten/core/Warp.h"

namespace tungsten {

namespace {

template <typename Model>
MaybeSample sampleCosine(const Model& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) {
    if (wi.z <= 0.0f || !at.wants(lobe::DiffuseReflection)) return std::nullopt;
    return smoothSample(model, at, wi, warp::squareToCosineHemisphere(u.direction), lobe::DiffuseReflection);
}

float pdfCosine(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (wi.z <= 0.0f || !at.wants(lobe::DiffuseReflection)) return 0.0f;
    return warp::squareToCosineHemispherePdf(wo);
}

} // namespace

Rgb Lambert::eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (wi.z <= 0.0f || wo.z <= 0.0f || !at.wants(lobe::DiffuseReflection)) return Rgb(0.0f);
    return at.albedo * (InvPi * wo.z);
}
float Lambert::pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    return pdfCosine(at, wi, wo);
}
MaybeSample Lambert::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    return sampleCosine(*this, at, wi, u);
}

/// The full model with interreflection (Oren and Nayar 1994); sigma = roughness / sqrt 2.
Rgb OrenNayar::eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (wi.z <= 0.0f || wo.z <= 0.0f || !at.wants(lobe::DiffuseReflection)) return Rgb(0.0f);
    const float s = 0.5f * sqr(roughness.scalar(at.query.uv));
    const float thetaI = std::acos(std::min(wi.z, 1.0f)), thetaO = std::acos(std::min(wo.z, 1.0f));
    const float alpha = std::max(thetaI, thetaO), beta = std::min(thetaI, thetaO);
    const float lengths = std::sqrt((wi.x * wi.x + wi.y * wi.y) * (wo.x * wo.x + wo.y * wo.y));
    const float cosPhi = lengths > 0.0f ? std::clamp((wi.x * wo.x + wi.y * wo.y) / lengths, -1.0f, 1.0f) : 1.0f;
    const float b = 2.0f * beta * InvPi;
    const float c1 = 1.0f - 0.5f * s / (s + 0.33f);
    const float c2 = 0.45f * s / (s + 0.09f) * (cosPhi >= 0.0f ? std::sin(alpha) : std::sin(alpha) - b * b * b);
    const float c3 = 0.125f * s / (s + 0.09f) * sqr(4.0f * alpha * beta * InvPi * InvPi);
    const float direct =
        c1 + cosPhi * c2 * std::tan(beta) + (1.0f - std::abs(cosPhi)) * c3 * std::tan(0.5f * (alpha + beta));
    const float interreflected = 0.17f * s / (s + 0.13f) * (1.0f - cosPhi * b * b);
    return (at.albedo * direct + at.albedo * at.albedo * interreflected) * (InvPi * wo.z);
}
float OrenNayar::pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    return pdfCosine(at, wi, wo);
}
MaybeSample OrenNayar::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    return sampleCosine(*this, at, wi, u);
}

OrenNayar OrenNayar::read(const BsdfReader& fields) {
    const float sigma = float(fields.number(
        "sigma", 0.0, {"radians", "standard deviation of the facets' slope, where `roughness` is not given"},
        Range::nonNegative()));
    return {{},
            fields.texture("roughness", Texture(std::sqrt(2.0f) * sigma),
                           {"none", "of the facets", "sigma times the square root of 2"}, {0.0, 10.0})};
}

} // namespace tungsten
