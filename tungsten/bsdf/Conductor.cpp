// Mirrors and metals, smooth and rough; the table of named metals.

#include "tungsten/bsdf/Fresnel.h"
#include "tungsten/bsdf/Microfacet.h"
#include "tungsten/bsdf/Models.h"

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

template <>
LobeMask lobesOf(const Mirror&) {
    return lobe::SpecularReflection;
}
template <>
Rgb evalModel(const Mirror&, const ModelPoint&, const Vec3f&, const Vec3f&) {
    return Rgb(0.0f);
}
template <>
float pdfModel(const Mirror&, const ModelPoint&, const Vec3f&, const Vec3f&) {
    return 0.0f;
}
template <>
MaybeSample sampleModel(const Mirror&, const ModelPoint& at, const Vec3f& wi, const BsdfRandom&) {
    return specularReflection(at, wi, at.albedo);
}

template <>
LobeMask lobesOf(const Conductor&) {
    return lobe::SpecularReflection;
}
template <>
Rgb evalModel(const Conductor&, const ModelPoint&, const Vec3f&, const Vec3f&) {
    return Rgb(0.0f);
}
template <>
float pdfModel(const Conductor&, const ModelPoint&, const Vec3f&, const Vec3f&) {
    return 0.0f;
}
template <>
MaybeSample sampleModel(const Conductor& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom&) {
    return specularReflection(at, wi, at.albedo * fresnelConductor(model.eta, model.k, wi.z));
}

template <>
LobeMask lobesOf(const RoughConductor&) {
    return lobe::GlossyReflection;
}
template <>
Rgb evalModel(const RoughConductor& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (wi.z <= 0.0f || wo.z <= 0.0f || !at.wants(lobe::GlossyReflection)) return Rgb(0.0f);
    const Microfacet facets(model.distribution, model.roughness.scalar(at.query.uv));
    const Vec3f m = (wi + wo).normalized();
    const Rgb fresnel = fresnelConductor(model.eta, model.k, wi.dot(m));
    return at.albedo * fresnel * (facets.density(m) * facets.shadowing(wi, wo, m) / (4.0f * wi.z));
}
template <>
float pdfModel(const RoughConductor& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    if (wi.z <= 0.0f || wo.z <= 0.0f || !at.wants(lobe::GlossyReflection)) return 0.0f;
    const Microfacet facets(model.distribution, model.roughness.scalar(at.query.uv));
    const Vec3f m = (wi + wo).normalized();
    return facets.pdf(wi, m) / (4.0f * std::abs(wi.dot(m)));
}
template <>
MaybeSample sampleModel(const RoughConductor& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) {
    if (wi.z <= 0.0f) return std::nullopt;
    const Microfacet facets(model.distribution, model.roughness.scalar(at.query.uv));
    const Vec3f wo = reflectedAbout(wi, facets.sample(wi, u.direction));
    return smoothSample(model, at, wi, wo, lobe::GlossyReflection);
}

} // namespace tungsten
