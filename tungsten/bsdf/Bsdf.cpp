#include "tungsten/bsdf/Bsdf.h"

#include "tungsten/bsdf/Lambertian.h"
#include "tungsten/bsdf/Models.h"
#include "tungsten/core/Overloaded.h"

namespace tungsten {

namespace {

template <typename Model>
concept Reflecting =
    OneOf<Model, Lambert, OrenNayar, Mirror, Conductor, RoughConductor, Plastic, RoughPlastic, PbrtPlastic, Null>;

} // namespace

Bsdf::Bsdf(std::string name_, BsdfModel model_, Texture albedo_)
    : name(std::move(name_)), model(std::move(model_)), albedo(std::move(albedo_)) {
    lobes_ = std::visit([](const auto& m) { return lobesOf(m); }, model);
}

Rgb Bsdf::eval(const BsdfQuery& query, const Vec3f& wi, const Vec3f& wo) const {
    if ((query.requested & lobes_ & lobe::Smooth) == 0) return Rgb(0.0f);
    const ModelPoint at{query, albedo.rgb(query.uv)};
    return std::visit([&](const auto& m) { return evalModel(m, at, wi, wo); }, model);
}

float Bsdf::pdf(const BsdfQuery& query, const Vec3f& wi, const Vec3f& wo) const {
    if ((query.requested & lobes_ & lobe::Smooth) == 0) return 0.0f;
    const ModelPoint at{query, albedo.rgb(query.uv)};
    return std::visit([&](const auto& m) { return pdfModel(m, at, wi, wo); }, model);
}

std::optional<BsdfSample> Bsdf::sample(const BsdfQuery& query, const Vec3f& wi, const BsdfRandom& u) const {
    if ((query.requested & lobes_) == 0) return std::nullopt;
    const ModelPoint at{query, albedo.rgb(query.uv)};
    return std::visit([&](const auto& m) { return sampleModel(m, at, wi, u); }, model);
}

Rgb Bsdf::forwardWeight(const Vec2f& uv) const {
    if ((lobes_ & lobe::Forward) == 0) return Rgb(0.0f);
    const BsdfQuery query{uv};
    const ModelPoint at{query, albedo.rgb(uv)};
    return std::visit(Overloaded{[&](const OneOf<Forward, Transparency, Mixed> auto& m) { return forwardOf(m, at); },
                                 [](const OneOf<Dielectric, RoughDielectric> auto&) { return Rgb(0.0f); },
                                 [](const Reflecting auto&) { return Rgb(0.0f); }},
                      model);
}

float relativeIndex(const Bsdf& bsdf) {
    return std::visit(Overloaded{[](const OneOf<Dielectric, RoughDielectric> auto& m) { return m.ior; },
                                 [](const OneOf<Forward, Transparency, Mixed> auto&) { return 1.0f; },
                                 [](const Reflecting auto&) { return 1.0f; }},
                      bsdf.model);
}

bool isLambertian(const Bsdf& bsdf) {
    return std::visit(
        Overloaded{[](const Lambert&) { return true; }, [](const Transparency& m) { return isLambertian(*m.base); },
                   [](const Mixed& m) { return isLambertian(*m.bsdf0) && isLambertian(*m.bsdf1); },
                   [](const OneOf<OrenNayar, Mirror, Conductor, RoughConductor, Dielectric, RoughDielectric, Plastic,
                                  RoughPlastic, PbrtPlastic, Null, Forward> auto&) { return false; }},
        bsdf.model);
}

} // namespace tungsten
