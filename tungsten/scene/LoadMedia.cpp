#include "tungsten/scene/LoadContext.h"

namespace tungsten {

namespace {

PhaseFunction readPhaseFunction(const ObjectReader& phase, Medium& medium) {
    const std::string type = phase.choice("type", "isotropic", phaseFunctionTypes());
    PhaseFunction result{Isotropic{}};
    if (type == "rayleigh") result.model = Rayleigh{};
    const bool guided = type == "ida" || type == "integrated_da";
    if (type == "henyey_greenstein" || guided)
        result.model = HenyeyGreenstein{float(phase.number("g", 0.0, {-0.999, 0.999}))};
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
    if (!medium.has("transmittance")) return;
    std::string type;
    if (medium.isText("transmittance"))
        type = medium.text("transmittance", "");
    else if (const auto object = medium.object("transmittance"))
        type = object->text("type", "");
    if (type != "exponential")
        medium.problem("transmittance", "only exponential transmittance is supported, found '" + type + "'");
}

Medium readMedium(const ObjectReader& reader) {
    Medium medium;
    medium.name = reader.text("name", "");
    const std::string type = reader.choice("type", "homogeneous", mediumTypes());
    if (!reader.has("type")) reader.problem("type", "a medium needs a type: " + listOf(mediumTypes()));
    const float density = float(reader.number("density", 1.0, Range::nonNegative()));
    medium.sigmaA = reader.rgb("sigma_a", Rgb(0.0f), Range::nonNegative()) * density;
    medium.sigmaS = reader.rgb("sigma_s", Rgb(0.0f), Range::nonNegative()) * density;
    medium.speedOfLight = float(reader.number("speed_of_light", 1.0, Range::positive()));
    medium.maxBounces = int(reader.integer("max_bounces", 1024, {0, 2e9}));
    medium.guided = type == "guided_homo";
    medium.phase = PhaseFunction{Isotropic{}};
    if (reader.isText("phase_function"))
        reader.problem("phase_function", "expected an object with a type, found a string");
    else if (const auto phase = reader.object("phase_function"))
        medium.phase = readPhaseFunction(*phase, medium);
    requireExponentialTransmittance(reader);
    if (medium.guided && !medium.scatters())
        reader.problem("sigma_s",
                       "a guided_homo medium must scatter (sigma_s > 0); use homogeneous for an absorbing one");
    reader.warnAboutUnknown();
    return medium;
}

int addMedium(LoadContext& context, const ObjectReader& reader) {
    context.scene.media.push_back(readMedium(reader));
    const int index = int(context.scene.media.size()) - 1;
    const std::string& name = context.scene.media.back().name;
    if (!name.empty()) context.media.emplace(name, index);
    return index;
}

} // namespace

std::vector<std::string> mediumTypes() {
    return {"homogeneous", "guided_homo"};
}

std::vector<std::string> phaseFunctionTypes() {
    return {"isotropic", "henyey_greenstein", "rayleigh", "ida", "integrated_da"};
}

void readMedia(LoadContext& context, const ObjectReader& root) {
    for (const ObjectReader& medium : root.objects("media")) addMedium(context, medium);
}

int readMediumReference(LoadContext& context, const ObjectReader& owner, const std::string& field) {
    if (owner.isObject(field)) return addMedium(context, *owner.object(field));
    const std::string name = owner.text(field, "");
    const auto found = context.media.find(name);
    if (found != context.media.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [known, index] : context.media) names.push_back(known);
    const std::string near = nearestName(name, names);
    if (owner.isText(field))
        owner.problem(field, "there is no medium called '" + name + "'" +
                                 (names.empty() ? "; the scene defines none" : "; known: " + listOf(names)) +
                                 (near.empty() ? "" : "; did you mean '" + near + "'?"));
    return -1;
}

} // namespace tungsten
