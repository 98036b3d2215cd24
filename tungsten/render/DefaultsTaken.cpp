#include "tungsten/render/DefaultsTaken.h"

#include "tungsten/render/Describe.h"
#include "tungsten/scene/Json.h"

#include <algorithm>

namespace tungsten {

namespace {

bool isCountOrLength(const Field& field) {
    const bool counted = field.unit == "none" || field.unit == "length" || field.unit == "samples/pixel";
    return counted && field.fallback != "0" && field.accepted.find("number") != std::string::npos;
}

/// The reason of an effect whose cause is the field: what was made for the scene.
std::string madeFor(const EffectPlan& plan, const std::string& field) {
    const auto causes = [&](const Effect& effect) {
        return std::find(effect.causes.begin(), effect.causes.end(), field) != effect.causes.end();
    };
    const auto effect = std::find_if(plan.effects.begin(), plan.effects.end(), causes);
    return effect == plan.effects.end() ? "" : effect->reason;
}

} // namespace

std::vector<DefaultTaken> defaultsTaken(const Job& job, const IntegratorRegistry& registry) {
    const auto document = parseJson(job.loaded.text, job.loaded.diagnostics->file);
    const ObjectReader root(document, nodeOf(*document), "", std::make_shared<Diagnostics>());
    const auto described = describeAll(registry);
    std::vector<DefaultTaken> taken;
    for (const auto& [block, type] : {std::pair<std::string, std::string>{"integrator", job.loaded.integratorType},
                                      std::pair<std::string, std::string>{"renderer", "renderer"}}) {
        const auto given = root.object(block, {"none", ""});
        for (const DescribedKind& kind : selectDescriptions(described, type))
            for (const auto& description : kind.types)
                for (const Field& field : description->fields) {
                    if (!isCountOrLength(field) || (given && given->has(field.name))) continue;
                    const std::string path = block + "." + field.name, made = madeFor(job.plan, path);
                    taken.push_back({path, made.empty() ? field.fallback : made, field.meaning});
                }
    }
    return taken;
}

} // namespace tungsten
