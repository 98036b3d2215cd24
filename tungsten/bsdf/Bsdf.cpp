#include "tungsten/bsdf/Bsdf.h"

namespace tungsten {

Bsdf::Bsdf(std::string name_, Bsdfs::Variant model_, Texture albedo_)
    : name(std::move(name_)), model(std::move(model_)), albedo(std::move(albedo_)) {
    lobes_ = std::visit([](const auto& m) { return m.lobes(); }, model);
}

Rgb Bsdf::eval(const BsdfQuery& query, const Vec3f& wi, const Vec3f& wo) const {
    if ((query.requested & lobes_ & lobe::Smooth) == 0) return Rgb(0.0f);
    const ModelPoint at{query, albedo.rgb(query.uv)};
    return std::visit([&](const auto& m) { return m.eval(at, wi, wo); }, model);
}

float Bsdf::pdf(const BsdfQuery& query, const Vec3f& wi, const Vec3f& wo) const {
    if ((query.requested & lobes_ & lobe::Smooth) == 0) return 0.0f;
    const ModelPoint at{query, albedo.rgb(query.uv)};
    return std::visit([&](const auto& m) { return m.pdf(at, wi, wo); }, model);
}

MaybeSample Bsdf::sample(const BsdfQuery& query, const Vec3f& wi, const BsdfRandom& u) const {
    if ((query.requested & lobes_) == 0) return std::nullopt;
    const ModelPoint at{query, albedo.rgb(query.uv)};
    return std::visit([&](const auto& m) { return m.sample(at, wi, u); }, model);
}

Rgb Bsdf::forwardWeight(const Vec2f& uv) const {
    if ((lobes_ & lobe::Forward) == 0) return Rgb(0.0f);
    const BsdfQuery query{uv};
    const ModelPoint at{query, albedo.rgb(uv)};
    return std::visit([&](const auto& m) { return m.forwardWeight(at); }, model);
}

float Bsdf::relativeIndex() const {
    return std::visit([](const auto& m) { return m.relativeIndex(); }, model);
}

bool Bsdf::isLambertian() const {
    return std::visit([](const auto& m) { return m.isLambertian(); }, model);
}

BsdfParts Bsdf::parts() const {
    return std::visit([](const auto& m) { return m.parts(); }, model);
}

} // namespace tungsten
