// Smooth and rough dielectric interfaces (Walter et al. 2007).

#include "tungsten/bsdf/BsdfReader.h"
#include "tungsten/bsdf/Fresnel.h"

namespace tungsten {

namespace {

/// n_incident / n_transmitted for a ray on the side of wi (outside: z > 0).
float relativeIor(float ior, const Vec3f& wi) {
    return wi.z > 0.0f ? 1.0f / ior : ior;
}

/// Radiance is squeezed by (n_i / n_t)^2 when it crosses; photons are not.
float crossingFactor(const ModelPoint& at, float eta) {
    return at.query.mode == TransportMode::Radiance ? eta * eta : 1.0f;
}

Vec3f flipped(const Vec3f& v, bool flip) {
    return flip ? Vec3f(v.x, v.y, -v.z) : v;
}

/// The rough interface seen from the upper side, whichever side that is.
struct RoughInterface {
    Microfacet facets;
    float eta;
    bool reflects, refracts;

    RoughInterface(const RoughDielectric& model, const ModelPoint& at, const Vec3f& wi)
        : facets(model.distribution, model.roughness.scalar(at.query.uv)), eta(relativeIor(model.ior, wi)),
          reflects(at.wants(lobe::GlossyReflection)),
          refracts(at.wants(lobe::GlossyTransmission) && model.enableRefraction) {}

    /// Probability of reflecting at a facet with reflectance F.
    [[nodiscard]] float reflectProbability(float fresnel) const {
        return reflects && refracts ? fresnel : (reflects ? 1.0f : 0.0f);
    }
    /// Facet normal (upper hemisphere) that refracts wi into wo.
    [[nodiscard]] Vec3f refractingNormal(const Vec3f& wi, const Vec3f& wo) const {
        const Vec3f m = (wi * eta + wo).normalized();
        return m.z < 0.0f ? -m : m;
    }
    /// d omega_m / d omega_o of refraction.
    [[nodiscard]] float refractionJacobian(const Vec3f& wi, const Vec3f& wo, const Vec3f& m) const {
        const float denominator = eta * wi.dot(m) + wo.dot(m);
        return std::abs(wo.dot(m)) / (denominator * denominator);
    }
    /// A refraction pair must lie on opposite sides of its facet, each on the side of the surface it belongs to.
    [[nodiscard]] static bool validRefraction(const Vec3f& wi, const Vec3f& wo, const Vec3f& m) {
        return wi.dot(m) > 0.0f && wo.dot(m) < 0.0f;
    }
};

} // namespace

MaybeSample Dielectric::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    float cosTransmitted = 0.0f;
    const float fresnel = fresnelDielectric(1.0f / ior, wi.z, cosTransmitted);
    const bool reflects = at.wants(lobe::SpecularReflection);
    const bool refracts = at.wants(lobe::SpecularTransmission) && enableRefraction;
    const float probability = reflects && refracts ? fresnel : (reflects ? 1.0f : 0.0f);
    if (u.lobe < probability)
        return BsdfSample{mirrored(wi), at.albedo * (fresnel / probability), probability, lobe::SpecularReflection};
    if (!refracts || fresnel >= 1.0f) return std::nullopt;
    const float eta = relativeIor(ior, wi);
    const Vec3f wo(-eta * wi.x, -eta * wi.y, wi.z > 0.0f ? -cosTransmitted : cosTransmitted);
    const float weight = (1.0f - fresnel) / (1.0f - probability) * crossingFactor(at, eta);
    return BsdfSample{wo.normalized(), at.albedo * weight, 1.0f - probability, lobe::SpecularTransmission};
}

Rgb RoughDielectric::eval(const ModelPoint& at, const Vec3f& worldWi, const Vec3f& worldWo) const {
    const bool below = worldWi.z < 0.0f;
    const Vec3f wi = flipped(worldWi, below), wo = flipped(worldWo, below);
    const RoughInterface interface(*this, at, worldWi);
    if (wi.z <= 0.0f || wo.z == 0.0f) return Rgb(0.0f);
    if (wo.z > 0.0f) {
        if (!interface.reflects) return Rgb(0.0f);
        const Vec3f m = (wi + wo).normalized();
        const float fresnel = fresnelDielectric(interface.eta, wi.dot(m));
        return at.albedo *
               (fresnel * interface.facets.density(m) * interface.facets.shadowing(wi, wo, m) / (4.0f * wi.z));
    }
    if (!interface.refracts) return Rgb(0.0f);
    const Vec3f m = interface.refractingNormal(wi, wo);
    if (!RoughInterface::validRefraction(wi, wo, m)) return Rgb(0.0f);
    const float fresnel = fresnelDielectric(interface.eta, wi.dot(m));
    const float value = wi.dot(m) * (1.0f - fresnel) * interface.facets.density(m) *
                        interface.facets.shadowing(wi, wo, m) * interface.refractionJacobian(wi, wo, m) / wi.z;
    return at.albedo * (value * crossingFactor(at, interface.eta));
}
float RoughDielectric::pdf(const ModelPoint& at, const Vec3f& worldWi, const Vec3f& worldWo) const {
    const bool below = worldWi.z < 0.0f;
    const Vec3f wi = flipped(worldWi, below), wo = flipped(worldWo, below);
    const RoughInterface interface(*this, at, worldWi);
    if (wi.z <= 0.0f || wo.z == 0.0f) return 0.0f;
    if (wo.z > 0.0f) {
        const Vec3f m = (wi + wo).normalized();
        const float fresnel = fresnelDielectric(interface.eta, wi.dot(m));
        return interface.reflectProbability(fresnel) * interface.facets.pdf(wi, m) / (4.0f * std::abs(wi.dot(m)));
    }
    const Vec3f m = interface.refractingNormal(wi, wo);
    if (!interface.refracts || !RoughInterface::validRefraction(wi, wo, m)) return 0.0f;
    const float fresnel = fresnelDielectric(interface.eta, wi.dot(m));
    return (1.0f - interface.reflectProbability(fresnel)) * interface.facets.pdf(wi, m) *
           interface.refractionJacobian(wi, wo, m);
}
MaybeSample RoughDielectric::sample(const ModelPoint& at, const Vec3f& worldWi, const BsdfRandom& u) const {
    const bool below = worldWi.z < 0.0f;
    const Vec3f wi = flipped(worldWi, below);
    if (wi.z <= 0.0f) return std::nullopt;
    const RoughInterface interface(*this, at, worldWi);
    const Vec3f m = interface.facets.sample(wi, u.direction);
    const float cosine = wi.dot(m);
    if (cosine <= 0.0f) return std::nullopt;
    float cosTransmitted = 0.0f;
    const float fresnel = fresnelDielectric(interface.eta, cosine, cosTransmitted);
    if (u.lobe < interface.reflectProbability(fresnel)) {
        const Vec3f wo = reflectedAbout(wi, m);
        if (wo.z <= 0.0f) return std::nullopt;
        return smoothSample(*this, at, worldWi, flipped(wo, below), lobe::GlossyReflection);
    }
    if (!interface.refracts || fresnel >= 1.0f) return std::nullopt;
    const Vec3f wo = (m * (interface.eta * cosine - cosTransmitted) - wi * interface.eta).normalized();
    if (wo.z >= 0.0f) return std::nullopt;
    return smoothSample(*this, at, worldWi, flipped(wo, below), lobe::GlossyTransmission);
}

namespace {

bool readRefraction(const BsdfReader& fields) {
    return fields.flag("enable_refraction", true, {"none", "false: light is only reflected"});
}

} // namespace

Dielectric Dielectric::read(const BsdfReader& fields) {
    return {{}, fields.ior(), readRefraction(fields)};
}

std::variant<RoughDielectric, Dielectric> RoughDielectric::read(const BsdfReader& fields) {
    RoughDielectric rough{
        {}, fields.ior(), fields.distribution(MicrofacetModel::Ggx), fields.roughness(0.1f), readRefraction(fields)};
    // Where hardly anything is refracted, directions no longer tell the facet they passed.
    constexpr float LeastContrast = 1e-4f;
    if (std::abs(rough.ior - 1.0f) < LeastContrast) return Dielectric{{}, 1.0f, rough.enableRefraction};
    return rough;
}

} // namespace tungsten
