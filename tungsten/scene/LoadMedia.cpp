#include "tungsten/reader/FormatTypes.h"
#include "tungsten/scene/LoadContext.h"

namespace tungsten {

namespace {

/// Names under which the models ask for guidance, too.
constexpr const char* GuidedMedium = "guided_homo";
const std::vector<std::string> GuidedPhases{"ida", "integrated_da"};

PhaseFunction readPhaseFunction(const ObjectReader& phase, Medium& medium) {
    const std::string type =
        phase.choice("type", Isotropic::Type, phaseFunctionTypes(), {"none", "which phase function"});
    const bool guided = std::find(GuidedPhases.begin(), GuidedPhases.end(), type) != GuidedPhases.end();
    const PhaseFunction result{PhaseFunctions::read(guided ? HenyeyGreenstein::Type : type, [&]<typename Model> {
        return PhaseFunctions::Variant(Model::read(phase));
    })};
    if (guided) {
        medium.guidedPhase = true;
        phase.accept({"table_path", "alpha", "dT_start", "dT_end", "max_T"});
        if (phase.has("table_path"))
            phase.warn("table_path", "table fields are ignored: direction tables are built when they are needed");
    }
    phase.accept({"name"});
    phase.warnAboutUnknown();
    return result;
}

void requireExponentialTransmittance(const ObjectReader& medium) {
    constexpr Meaning meaning{"none", "law by which light dies away with length", "exponential"};
    medium.declare("transmittance", "exponential, or an object of that type", "exponential", meaning);
    if (!medium.has("transmittance")) return;
    std::string type;
    if (medium.isText("transmittance"))
        type = medium.text("transmittance", "", meaning);
    else if (const auto object = medium.object("transmittance", meaning))
        type = object->text("type", "", {"none", "which law"});
    if (type != "exponential")
        medium.problem("transmittance", refusal(type, "'" + type + "'", {"exponential"}, unsupportedTransmittances()));
}

Medium readMedium(const ObjectReader& reader) {
    Medium medium;
    const std::string type = reader.choice("type", Homogeneous::Type, mediumTypes(),
                                           {"none", "which medium", "required"}, unsupportedMedia());
    medium.name = reader.text("name", "", NameMeaning);
    medium.path = reader.path();
    if (!reader.has("type")) reader.problem("type", "a medium needs a type: " + listOf(mediumTypes()));
    medium.guided = type == GuidedMedium;
    medium.model = Media::read(medium.guided ? Homogeneous::Type : type,
                               [&]<typename Model> { return Media::Variant(Model::read(reader)); });
    medium.speedOfLight = float(reader.number(
        "speed_of_light", 1.0, {"length/time", "speed at which light travels in it"}, Range::positiveMeasure()));
    medium.maxBounces =
        int(reader.integer("max_bounces", 1024, {"none", "scatterings after a surface at which paths end"}, {0, 2e9}));
    constexpr Meaning phaseMeaning{"none", "how directions change; {\"type\": ...}", "isotropic"};
    if (reader.isText("phase_function"))
        reader.problem("phase_function", "expected an object with a type, found a string");
    else if (const auto phase = reader.object("phase_function", phaseMeaning))
        medium.phase = readPhaseFunction(*phase, medium);
    requireExponentialTransmittance(reader);
    if (medium.guided && !medium.scatters())
        reader.problem("sigma_s",
                       "a guided_homo medium must scatter (sigma_s > 0); use homogeneous for an absorbing one");
    reader.warnAboutUnknown();
    return medium;
}

/// A speed that is left out is 1, whatever it is elsewhere.
void warnAboutSpeed(const ObjectReader& reader, const Medium& medium, const TransportSettings& transport) {
    if (transport.gate.steadyState || reader.has("speed_of_light") || transport.vacuumSpeed == medium.speedOfLight)
        return;
    char text[160];
    std::snprintf(
        text, sizeof text,
        "not given: light travels at %g here, and at %g outside media (vacuum_speed_of_light); say it for both",
        double(medium.speedOfLight), double(transport.vacuumSpeed));
    reader.warn("speed_of_light", text);
}

int addMedium(LoadContext& context, const ObjectReader& reader) {
    context.scene.media.push_back(readMedium(reader));
    warnAboutSpeed(reader, context.scene.media.back(), context.scene.transport);
    const int index = int(context.scene.media.size()) - 1;
    const std::string& name = context.scene.media.back().name;
    if (!name.empty()) context.media.emplace(name, index);
    return index;
}

std::string unknownMedium(const LoadContext& context, const ObjectReader& owner, const std::string& name) {
    constexpr size_t MostNamed = 12;
    std::vector<std::string> names;
    for (const auto& [known, index] : context.media) {
        if (names.size() == MostNamed) break;
        names.push_back(known);
    }
    return "there is no medium called '" + name + "'" +
           (names.empty() ? "; the scene defines none" : "; known: " + listOf(names)) +
           (context.media.size() > names.size() ? " and others" : "") + didYouMean(name, context.media, owner);
}

} // namespace

std::vector<std::string> mediumTypes() {
    std::vector<std::string> types = Media::names();
    types.emplace_back(GuidedMedium);
    return types;
}

std::vector<std::string> phaseFunctionTypes() {
    std::vector<std::string> types = PhaseFunctions::names();
    types.insert(types.end(), GuidedPhases.begin(), GuidedPhases.end());
    return types;
}

void readMedia(LoadContext& context, const ObjectReader& root) {
    for (const ObjectReader& medium : root.objects("media", {"none", "what fills the space between surfaces"}))
        addMedium(context, medium);
}

void describeMedium(const std::shared_ptr<Description>& description) {
    readMedium(ObjectReader::describing(description, description->name));
}

void describePhaseFunction(const std::shared_ptr<Description>& description) {
    Medium scratch;
    readPhaseFunction(ObjectReader::describing(description, description->name), scratch);
}

int readMediumReference(LoadContext& context, const ObjectReader& owner, const std::string& field,
                        const Meaning& meaning) {
    owner.declare(field, "the name of a medium, or a medium", "vacuum", meaning);
    if (!owner.has(field)) return -1;
    if (owner.isObject(field)) return addMedium(context, *owner.object(field, meaning));
    const std::string name = owner.text(field, "", meaning);
    const auto found = context.media.find(name);
    if (found != context.media.end()) return found->second;
    if (owner.isText(field)) owner.problem(field, unknownMedium(context, owner, name));
    return -1;
}

} // namespace tungsten
