#include "tungsten/reader/FormatTypes.h"
#include "tungsten/scene/LoadContext.h"

#include <functional>

namespace tungsten {

namespace {

constexpr double LargestIor = 100.0;

float readIor(const ObjectReader& reader) {
    return float(
        reader.number("ior", 1.5, {"none", "index of refraction inside, relative to outside"}, {1e-2, LargestIor}));
}

MicrofacetModel readDistribution(const ObjectReader& reader, const std::string& fallback) {
    static const std::map<std::string, MicrofacetModel> models{{"beckmann", MicrofacetModel::Beckmann},
                                                               {"ggx", MicrofacetModel::Ggx},
                                                               {"phong", MicrofacetModel::Phong},
                                                               {"pbrt-ggx", MicrofacetModel::PbrtGgx}};
    std::vector<std::string> names;
    for (const auto& [name, model] : models) names.push_back(name);
    return models.at(
        reader.choice("distribution", fallback, names, {"none", "how the facets' normals are distributed"}));
}

Texture readRoughness(LoadContext& context, const ObjectReader& reader, float fallback) {
    return readTexture(context, reader, "roughness", Texture(fallback),
                       {"none", "width of the facets' distribution, not squared"}, {0.0, 10.0});
}

/// A material name wins over eta and k, which replace the default only together.
std::pair<Rgb, Rgb> readConductor(const ObjectReader& reader) {
    std::pair<Rgb, Rgb> optics = *conductorByName("Cu");
    const Rgb eta = reader.rgb("eta", optics.first, {"none", "index of refraction, with `k`", "copper's"}, {1e-6, 1e6});
    const Rgb k = reader.rgb("k", optics.second, {"none", "extinction index, with `eta`", "copper's"}, {0.0, 1e6});
    const std::string material =
        reader.choice("material", "Cu", conductorNames(), {"none", "metal whose `eta` and `k` are used instead"},
                      unsupportedMetals());
    if (reader.has("eta") != reader.has("k"))
        reader.warn(reader.has("eta") ? "eta" : "k", "eta and k take effect only together; copper is used");
    else
        optics = {eta, k};
    if (reader.has("material"))
        if (const auto named = conductorByName(material)) optics = *named;
    return optics;
}

BsdfModel readOrenNayar(LoadContext& context, const ObjectReader& reader) {
    const float sigma = float(reader.number(
        "sigma", 0.0, {"radians", "standard deviation of the facets' slope, where `roughness` is not given"},
        Range::nonNegative()));
    return OrenNayar{readTexture(context, reader, "roughness", Texture(std::sqrt(2.0f) * sigma),
                                 {"none", "of the facets", "sigma times the square root of 2"}, {0.0, 10.0})};
}

BsdfModel readRoughConductor(LoadContext& context, const ObjectReader& reader) {
    const auto [eta, k] = readConductor(reader);
    return RoughConductor{eta, k, readDistribution(reader, "ggx"), readRoughness(context, reader, 0.1f)};
}

BsdfModel readConductorModel(LoadContext&, const ObjectReader& reader) {
    const auto [eta, k] = readConductor(reader);
    return Conductor{eta, k};
}

bool readRefraction(const ObjectReader& reader) {
    return reader.flag("enable_refraction", true, {"none", "false: light is only reflected"});
}

float readThickness(const ObjectReader& reader) {
    return float(reader.number("thickness", 1.0, {"length", "of the coat, for absorption"}, Range::nonNegative()));
}

Rgb readCoatAbsorption(const ObjectReader& reader) {
    return reader.rgb("sigma_a", Rgb(0.0f), {"1/length", "absorption in the coat"}, Range::nonNegative());
}

Rgb readSpecularFactor(const ObjectReader& reader, float fallback) {
    return reader.rgb("Ks", Rgb(fallback), {"none", "factor on what the coat reflects"}, Range::nonNegative());
}

BsdfModel readDielectric(LoadContext&, const ObjectReader& reader) {
    return Dielectric{readIor(reader), readRefraction(reader)};
}

BsdfModel readRoughDielectric(LoadContext& context, const ObjectReader& reader) {
    RoughDielectric rough{readIor(reader), readDistribution(reader, "ggx"), readRoughness(context, reader, 0.1f),
                          readRefraction(reader)};
    // Where hardly anything is refracted, directions no longer tell the facet they passed.
    constexpr float LeastContrast = 1e-4f;
    if (std::abs(rough.ior - 1.0f) < LeastContrast) return Dielectric{1.0f, rough.enableRefraction};
    return rough;
}

BsdfModel readPlastic(LoadContext&, const ObjectReader& reader) {
    return makePlastic(readIor(reader), readThickness(reader), readCoatAbsorption(reader));
}

BsdfModel readRoughPlastic(LoadContext& context, const ObjectReader& reader) {
    return makeRoughPlastic(readIor(reader), readThickness(reader), readCoatAbsorption(reader),
                            readDistribution(reader, "ggx"), readRoughness(context, reader, 0.02f),
                            readSpecularFactor(reader, 1.0f));
}

BsdfModel readPbrtPlastic(LoadContext& context, const ObjectReader& reader) {
    return PbrtPlastic{readIor(reader), readDistribution(reader, "pbrt-ggx"), readRoughness(context, reader, 0.1f),
                       readSpecularFactor(reader, 0.25f)};
}

BsdfPtr defaultBsdf() {
    return std::make_shared<const Bsdf>("", BsdfModel(Lambert{}));
}

BsdfModel readTransparency(LoadContext& context, const ObjectReader& reader) {
    const BsdfPtr base =
        readBsdfReference(context, reader, "base", {"none", "what is seen where alpha is 1", "white Lambert"});
    return Transparency{base, readTexture(context, reader, "alpha", Texture(1.0f),
                                          {"none", "opacity: 0 lets everything straight through"}, Range::unit())};
}

BsdfModel readMixed(LoadContext& context, const ObjectReader& reader) {
    for (const char* field : {"bsdf0", "bsdf1"})
        if (!reader.has(field)) reader.problem(field, "a mixed BSDF needs bsdf0 and bsdf1");
    return Mixed{readBsdfReference(context, reader, "bsdf0", {"none", "mixed with the share `ratio`", "required"}),
                 readBsdfReference(context, reader, "bsdf1", {"none", "the rest of the mixture", "required"}),
                 readTexture(context, reader, "ratio", Texture(0.5f), {"none", "share of bsdf0"}, Range::unit())};
}

using ModelReader = std::function<BsdfModel(LoadContext&, const ObjectReader&)>;

template <typename Model>
BsdfModel plainModel(LoadContext&, const ObjectReader&) {
    return Model{};
}

const std::map<std::string, ModelReader>& modelReaders() {
    static const std::map<std::string, ModelReader> readers{{"lambert", plainModel<Lambert>},
                                                            {"oren_nayar", readOrenNayar},
                                                            {"mirror", plainModel<Mirror>},
                                                            {"conductor", readConductorModel},
                                                            {"rough_conductor", readRoughConductor},
                                                            {"dielectric", readDielectric},
                                                            {"rough_dielectric", readRoughDielectric},
                                                            {"plastic", readPlastic},
                                                            {"rough_plastic", readRoughPlastic},
                                                            {"pbrt_plastic", readPbrtPlastic},
                                                            {"null", plainModel<Null>},
                                                            {"forward", plainModel<Forward>},
                                                            {"transparency", readTransparency},
                                                            {"mixed", readMixed}};
    return readers;
}

/// Every evaluation visits every part, also where one BSDF is named several times.
constexpr size_t MostParts = 256;

/// BSDFs that this one consists of, itself included; counted until there are more than `most`.
size_t parts(const Bsdf& bsdf, size_t most) {
    size_t count = 1;
    const auto add = [&](const BsdfPtr& part) {
        if (count <= most) count += parts(*part, most - count);
    };
    std::visit(Overloaded{[&](const Mixed& mixed) {
                              add(mixed.bsdf0);
                              add(mixed.bsdf1);
                          },
                          [&](const Transparency& transparency) { add(transparency.base); },
                          [](const OneOf<Lambert, OrenNayar, Mirror, Conductor, RoughConductor, Dielectric,
                                         RoughDielectric, Plastic, RoughPlastic, PbrtPlastic, Null, Forward> auto&) {}},
               bsdf.model);
    return count;
}

BsdfPtr readBsdf(LoadContext& context, const ObjectReader& reader) {
    std::vector<std::string> types;
    for (const auto& [type, modelReader] : modelReaders()) types.push_back(type);
    if (!reader.has("type")) reader.problem("type", "a BSDF needs a type: " + listOf(types));
    const std::string type =
        reader.choice("type", "lambert", types, {"none", "which BSDF", "required"}, unsupportedBsdfs());
    const std::string name = reader.text("name", "", NameMeaning);
    Texture albedo = readTexture(context, reader, "albedo", Texture(1.0f),
                                 {"none", "factor on the model's reflectance"}, Range::unit());
    BsdfModel model = modelReaders().at(type)(context, reader);
    auto bsdf = std::make_shared<Bsdf>(name, std::move(model), std::move(albedo));
    if (parts(*bsdf, MostParts) > MostParts) {
        reader.problem("", "consists of more than " + std::to_string(MostParts) + " BSDFs within one another");
        bsdf = std::make_shared<Bsdf>(name, Lambert{});
    }
    Texture bump =
        readTexture(context, reader, "bump", Texture(0.0f), {"length", "height that tilts the shading normal"});
    if (!bump.isConstant()) bsdf->bump = std::move(bump);
    reader.warnAboutUnknown();
    if (!name.empty()) context.bsdfs.emplace(name, bsdf);
    return bsdf;
}

BsdfPtr bsdfByName(LoadContext& context, const ObjectReader& owner, const std::string& field, const std::string& name) {
    const auto found = context.bsdfs.find(name);
    if (found != context.bsdfs.end()) return found->second;
    owner.problem(field, "there is no BSDF called '" + name + "' above it" + didYouMean(name, context.bsdfs, owner));
    return defaultBsdf();
}

} // namespace

std::vector<std::string> bsdfTypes() {
    std::vector<std::string> types;
    for (const auto& [type, reader] : modelReaders()) types.push_back(type);
    return types;
}

void readBsdfs(LoadContext& context, const ObjectReader& root) {
    for (const ObjectReader& bsdf : root.objects("bsdfs", {"none", "how surfaces scatter"})) readBsdf(context, bsdf);
}

void describeBsdf(const std::shared_ptr<Description>& description) {
    ScratchContext scratch;
    readBsdf(scratch.context, ObjectReader::describing(description, description->name));
}

BsdfPtr readBsdfReference(LoadContext& context, const ObjectReader& owner, const std::string& field,
                          const Meaning& meaning) {
    owner.declare(field, "the name of a BSDF, or a BSDF", "none", meaning);
    if (!owner.has(field)) return defaultBsdf();
    if (owner.isText(field)) return bsdfByName(context, owner, field, owner.text(field, "", meaning));
    if (const auto inlined = owner.object(field, meaning)) return readBsdf(context, *inlined);
    return defaultBsdf();
}

std::vector<BsdfPtr> readBsdfList(LoadContext& context, const ObjectReader& owner, const std::string& field,
                                  const Meaning& meaning) {
    owner.declare(field, "the name of a BSDF, a BSDF, or an array of both", "none", meaning);
    if (owner.describes()) return {defaultBsdf()};
    if (!owner.isArray(field)) return {readBsdfReference(context, owner, field, meaning)};
    std::vector<BsdfPtr> list;
    for (size_t i = 0; i < owner.arraySize(field); ++i) {
        const std::string item = field + "[" + std::to_string(i) + "]";
        if (const auto name = owner.arrayText(field, i))
            list.push_back(bsdfByName(context, owner, item, *name));
        else if (const auto inlined = owner.arrayObject(field, i))
            list.push_back(readBsdf(context, *inlined));
        else
            owner.problem(item, "expected the name of a BSDF or an object");
    }
    if (list.empty()) {
        owner.problem(field, "expected at least one BSDF, found an empty array");
        list.push_back(defaultBsdf());
    }
    return list;
}

} // namespace tungsten
