#include "tungsten/bsdf/Microfacet.h"

#include "tungsten/core/Warp.h"

namespace tungsten {

namespace {

constexpr float SmallestRoughness = 1e-3f;

float tanSquared(const Vec3f& v) {
    return std::max(1.0f - v.z * v.z, 0.0f) / (v.z * v.z);
}

Vec3f fromCosine(float cosTheta, float sinTheta, float u) {
    const float phi = 2.0f * Pi * u;
    return {sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta};
}

/// Schlick-style rational fit of the Beckmann shadowing, a = 1 / (alpha tan theta) (Walter et al. 2007).
float rationalShadowing(float a) {
    return a < 1.6f ? (3.535f * a + 2.181f * a * a) / (1.0f + 2.276f * a + 2.577f * a * a) : 1.0f;
}

} // namespace

Microfacet::Microfacet(MicrofacetModel model, float roughness)
    : model_(model), alpha_(std::max(roughness, SmallestRoughness)), exponent_(2.0f / (alpha_ * alpha_) - 2.0f) {}

float Microfacet::density(const Vec3f& m) const {
    if (m.z <= 0.0f) return 0.0f;
    const float cos2 = m.z * m.z;
    switch (model_) {
    case MicrofacetModel::Beckmann:
        return InvPi * std::exp(-tanSquared(m) / sqr(alpha_)) / (sqr(alpha_) * sqr(cos2));
    case MicrofacetModel::Phong:
        return (exponent_ + 2.0f) * 0.5f * InvPi * std::pow(m.z, exponent_);
    case MicrofacetModel::Ggx:
    case MicrofacetModel::PbrtGgx:
        break;
    }
    // alpha^2 / (pi (cos^2 (alpha^2 - 1) + 1)^2) with 1 - cos^2 from x and y: exact at small angles.
    const float sin2 = m.x * m.x + m.y * m.y;
    return sqr(alpha_) * InvPi / sqr(sqr(alpha_) * cos2 + sin2);
}

float Microfacet::shadowingOne(const Vec3f& v, const Vec3f& m) const {
    if (v.dot(m) * v.z <= 0.0f) return 0.0f;
    const float tan2 = tanSquared(v);
    if (tan2 <= 0.0f) return 1.0f;
    switch (model_) {
    case MicrofacetModel::Beckmann:
        return rationalShadowing(1.0f / (alpha_ * std::sqrt(tan2)));
    case MicrofacetModel::Phong:
        return rationalShadowing(std::sqrt((0.5f * exponent_ + 1.0f) / tan2));
    case MicrofacetModel::Ggx:
    case MicrofacetModel::PbrtGgx:
        break;
    }
    return 2.0f / (1.0f + std::sqrt(1.0f + sqr(alpha_) * tan2));
}

float Microfacet::shadowing(const Vec3f& wi, const Vec3f& wo, const Vec3f& m) const {
    if (model_ != MicrofacetModel::PbrtGgx) return shadowingOne(wi, m) * shadowingOne(wo, m);
    if (wi.dot(m) * wi.z <= 0.0f || wo.dot(m) * wo.z <= 0.0f) return 0.0f;
    const auto lambda = [this](const Vec3f& v) {
        return 0.5f * (std::sqrt(1.0f + sqr(alpha_) * tanSquared(v)) - 1.0f);
    };
    return 1.0f / (1.0f + lambda(wi) + lambda(wo));
}

Vec3f Microfacet::sample(const Vec3f& wi, const Vec2f& u) const {
    if (model_ == MicrofacetModel::Beckmann) {
        const float tan2 = -sqr(alpha_) * std::log1p(-u.x);
        const float cosTheta = 1.0f / std::sqrt(1.0f + tan2);
        return fromCosine(cosTheta, std::sqrt(tan2) * cosTheta, u.y);
    }
    if (model_ == MicrofacetModel::Phong) {
        const float cosTheta = std::pow(1.0f - u.x, 1.0f / (exponent_ + 2.0f));
        return fromCosine(cosTheta, std::sqrt(std::max(1.0f - sqr(cosTheta), 0.0f)), u.y);
    }
    // Heitz 2018: stretch the view, sample the projected hemisphere, unstretch.
    const Vec3f view = Vec3f(alpha_ * wi.x, alpha_ * wi.y, wi.z).normalized();
    const float length2 = view.x * view.x + view.y * view.y;
    const Vec3f t1 = length2 > 0.0f ? Vec3f(-view.y, view.x, 0.0f) / std::sqrt(length2) : Vec3f(1, 0, 0);
    const Vec3f t2 = view.cross(t1);
    const Vec2f disk = warp::squareToDisk(u);
    const float s = 0.5f * (1.0f + view.z);
    const float y = (1.0f - s) * std::sqrt(std::max(1.0f - disk.x * disk.x, 0.0f)) + s * disk.y;
    const float z = std::sqrt(std::max(1.0f - disk.x * disk.x - y * y, 0.0f));
    const Vec3f n = t1 * disk.x + t2 * y + view * z;
    return Vec3f(alpha_ * n.x, alpha_ * n.y, std::max(n.z, 1e-6f)).normalized();
}

float Microfacet::pdf(const Vec3f& wi, const Vec3f& m) const {
    const float d = density(m);
    if (!isGgx()) return d * m.z;
    const float cosine = wi.dot(m);
    if (cosine <= 0.0f || wi.z <= 0.0f) return 0.0f;
    const float g1 = 2.0f / (1.0f + std::sqrt(1.0f + sqr(alpha_) * tanSquared(wi)));
    return g1 * d * cosine / wi.z;
}

} // namespace tungsten
