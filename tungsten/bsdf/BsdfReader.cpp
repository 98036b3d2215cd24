#include "tungsten/bsdf/BsdfReader.h"

#include "tungsten/reader/FormatTypes.h"

namespace tungsten {

namespace {

BsdfPtr defaultBsdf() {
    return std::make_shared<const Bsdf>("", Bsdfs::Variant(Lambert{}));
}

/// Every evaluation visits every part, also where one BSDF is named several times.
constexpr size_t MostParts = 256;

/// BSDFs that this one consists of, itself included; counted until there are more than `most`.
size_t countParts(const Bsdf& bsdf, size_t most) {
    size_t count = 1;
    for (const BsdfPtr& part : bsdf.parts().bsdfs)
        if (count <= most) count += countParts(*part, most - count);
    return count;
}

/// What a model's reader makes: the model, or one of several.
template <typename Read>
Bsdfs::Variant modelOf(Read read) {
    if constexpr (std::constructible_from<Bsdfs::Variant, Read>)
        return read;
    else
        return std::visit([](auto& model) { return Bsdfs::Variant(std::move(model)); }, read);
}

} // namespace

float BsdfReader::ior() const {
    constexpr double LargestIor = 100.0;
    return float(number("ior", 1.5, {"none", "index of refraction inside, relative to outside"}, {1e-2, LargestIor}));
}

MicrofacetModel BsdfReader::distribution(MicrofacetModel fallback) const {
    static const std::map<std::string, MicrofacetModel> models{{"beckmann", MicrofacetModel::Beckmann},
                                                               {"ggx", MicrofacetModel::Ggx},
                                                               {"phong", MicrofacetModel::Phong},
                                                               {"pbrt-ggx", MicrofacetModel::PbrtGgx}};
    std::vector<std::string> names;
    std::string nameOfFallback;
    for (const auto& [name, model] : models) {
        names.push_back(name);
        if (model == fallback) nameOfFallback = name;
    }
    return models.at(
        choice("distribution", nameOfFallback, names, {"none", "how the facets' normals are distributed"}));
}

Texture BsdfReader::roughness(float fallback) const {
    return texture("roughness", Texture(fallback), {"none", "width of the facets' distribution, not squared"},
                   {0.0, 10.0});
}

BsdfPtr BsdfReader::asBsdf() const {
    const std::vector<std::string> types = Bsdfs::types();
    if (!has("type")) problem("type", "a BSDF needs a type: " + listOf(types));
    const std::string type =
        choice("type", Lambert::Type, types, {"none", "which BSDF", "required"}, unsupportedBsdfs());
    const std::string name = text("name", "", NameMeaning);
    Texture albedo = texture("albedo", Texture(1.0f), {"none", "factor on the model's reflectance"}, Range::unit());
    Bsdfs::Variant model = Bsdfs::read(type, [&]<typename Model> { return modelOf(Model::read(*this)); });
    auto bsdf = std::make_shared<Bsdf>(name, std::move(model), std::move(albedo));
    if (countParts(*bsdf, MostParts) > MostParts) {
        problem("", "consists of more than " + std::to_string(MostParts) + " BSDFs within one another");
        bsdf = std::make_shared<Bsdf>(name, Lambert{});
    }
    Texture bump = texture("bump", Texture(0.0f), {"length", "height that tilts the shading normal"});
    if (!bump.isConstant()) bsdf->bump = std::move(bump);
    warnAboutUnknown();
    if (!name.empty()) named_->emplace(name, bsdf);
    return bsdf;
}

BsdfPtr BsdfReader::byName(const std::string& field, const std::string& name) const {
    const auto found = named_->find(name);
    if (found != named_->end()) return found->second;
    problem(field, "there is no BSDF called '" + name + "' above it" + didYouMean(name, *named_, *this));
    return defaultBsdf();
}

BsdfPtr BsdfReader::bsdf(const std::string& field, const Meaning& meaning) const {
    declare(field, "the name of a BSDF, or a BSDF", "none", meaning);
    if (!has(field)) return defaultBsdf();
    if (isText(field)) return byName(field, text(field, "", meaning));
    if (const auto inlined = object(field, meaning)) return of(*inlined).asBsdf();
    return defaultBsdf();
}

std::vector<BsdfPtr> BsdfReader::bsdfs(const std::string& field, const Meaning& meaning) const {
    declare(field, "the name of a BSDF, a BSDF, or an array of both", "none", meaning);
    if (describes()) return {defaultBsdf()};
    if (!isArray(field)) return {bsdf(field, meaning)};
    std::vector<BsdfPtr> list;
    for (size_t i = 0; i < arraySize(field); ++i) {
        const std::string item = field + "[" + std::to_string(i) + "]";
        if (const auto name = arrayText(field, i))
            list.push_back(byName(item, *name));
        else if (const auto inlined = arrayObject(field, i))
            list.push_back(of(*inlined).asBsdf());
        else
            problem(item, "expected the name of a BSDF or an object");
    }
    if (list.empty()) {
        problem(field, "expected at least one BSDF, found an empty array");
        list.push_back(defaultBsdf());
    }
    return list;
}

void describeBsdf(const std::shared_ptr<Description>& description) {
    const Resources none;
    Bitmaps bitmaps;
    NamedBsdfs named;
    BsdfReader({ObjectReader::describing(description, description->name), none, bitmaps}, named).asBsdf();
}

} // namespace tungsten
