// Mirrors and metals, smooth and rough; the table of named metals.

#include "tungsten/bsdf/BsdfReader.h"
#include "tungsten/bsdf/Fresnel.h"
#include "tungsten/reader/FormatTypes.h"

#include <map>

namespace tungsten {

namespace {

MaybeSample specularReflection(const ModelPoint& at, const Vec3f& wi, const Rgb& weight) {
    if (!at.wants(lobe::SpecularReflection)) return std::nullopt;
    return BsdfSample{mirrored(wi), weight, 1.0f, lobe::SpecularReflection};
}

struct Optics {
    Rgb eta, k;
};

const std::map<std::string, Optics>& metals() {
    static const std::map<std::string, Optics> table{
        {"Ag", {{0.1552646489f, 0.1167232965f, 0.1383806959f}, {4.8283433224f, 3.1222459278f, 2.1469504455f}}},
        {"Al", {{1.6574599595f, 0.8803689579f, 0.5212287346f}, {9.2238691996f, 6.2695232477f, 4.8370012281f}}},
        {"Au", {{0.1431189557f, 0.3749570432f, 1.4424785571f}, {3.9831604247f, 2.3857207478f, 1.6032152899f}}},
        {"Cr", {{4.3696828663f, 2.9167024892f, 1.6547005413f}, {5.2064337956f, 4.2313645277f, 3.7549467933f}}},
        {"Cu", {{0.2004376970f, 0.9240334304f, 1.1022119527f}, {3.9129485033f, 2.4528477015f, 2.1421879552f}}},
        {"Li", {{0.2657871942f, 0.1956102432f, 0.2209198538f}, {3.5401743407f, 2.3111306542f, 1.6685930000f}}},
        {"VN", {{2.8656011588f, 2.1191817791f, 1.9400767149f}, {3.0323264950f, 2.0561075580f, 1.6162930914f}}}};
    return table;
}

} // namespace

std::optional<std::pair<Rgb, Rgb>> conductorByName(const std::string& name) {
    const auto found = metals().find(name);
    if (found == metals().end()) return std::nullopt;
    return std::pair{found->second.eta, found->second.k};
}

std::vector<std::string> conductorNames() {
    std::vector<std::string> names;
    for (const auto& [name, optics] : metals()) names.push_back(name);
    return names;
}

MaybeSample Mirror::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom&) const {
    return specularReflection(at, wi, at.albedo);
}

MaybeSample Conductor::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom&) const {
    return specularReflection(at, wi, at.albedo * fresnelConductor(eta, k, wi.z));
}

Rgb RoughConductor::eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (wi.z <= 0.0f || wo.z <= 0.0f || !at.wants(lobe::GlossyReflection)) return Rgb(0.0f);
    const Microfacet facets(distribution, roughness.scalar(at.query.uv));
    const Vec3f m = (wi + wo).normalized();
    const Rgb fresnel = fresnelConductor(eta, k, wi.dot(m));
    return at.albedo * fresnel * (facets.density(m) * facets.shadowing(wi, wo, m) / (4.0f * wi.z));
}
float RoughConductor::pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    if (wi.z <= 0.0f || wo.z <= 0.0f || !at.wants(lobe::GlossyReflection)) return 0.0f;
    const Microfacet facets(distribution, roughness.scalar(at.query.uv));
    const Vec3f m = (wi + wo).normalized();
    return facets.pdf(wi, m) / (4.0f * std::abs(wi.dot(m)));
}
MaybeSample RoughConductor::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    if (wi.z <= 0.0f) return std::nullopt;
    const Microfacet facets(distribution, roughness.scalar(at.query.uv));
    const Vec3f wo = reflectedAbout(wi, facets.sample(wi, u.direction));
    return smoothSample(*this, at, wi, wo, lobe::GlossyReflection);
}

namespace {

/// A material name wins over eta and k, which replace the default only together.
Optics readOptics(const BsdfReader& fields) {
    Optics optics = metals().at("Cu");
    const Rgb eta = fields.rgb("eta", optics.eta, {"none", "index of refraction, with `k`", "copper's"}, {1e-6, 1e6});
    const Rgb k = fields.rgb("k", optics.k, {"none", "extinction index, with `eta`", "copper's"}, {0.0, 1e6});
    const std::string material =
        fields.choice("material", "Cu", conductorNames(), {"none", "metal whose `eta` and `k` are used instead"},
                      unsupportedMetals());
    if (fields.has("eta") != fields.has("k"))
        fields.warn(fields.has("eta") ? "eta" : "k", "eta and k take effect only together; copper is used");
    else
        optics = {eta, k};
    return fields.has("material") ? metals().at(material) : optics;
}

} // namespace

Conductor Conductor::read(const BsdfReader& fields) {
    const Optics optics = readOptics(fields);
    return {{}, optics.eta, optics.k};
}

RoughConductor RoughConductor::read(const BsdfReader& fields) {
    const Optics optics = readOptics(fields);
    return {{}, optics.eta, optics.k, fields.distribution(MicrofacetModel::Ggx), fields.roughness(0.1f)};
}

} // namespace tungsten
