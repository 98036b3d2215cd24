#include "tungsten/render/PlanReport.h"

#include <algorithm>
#include <iomanip>
#include <ostream>

namespace tungsten {

void EffectPlan::count(const std::string& effect, const std::vector<std::string>& counters) {
    for (Effect& described : effects)
        if (described.name == effect)
            described.counters.insert(described.counters.end(), counters.begin(), counters.end());
}

void printPlan(const EffectPlan& plan, std::ostream& out) {
    size_t width = 0;
    for (const Effect& effect : plan.effects) width = std::max(width, effect.name.size());
    for (const Effect& effect : plan.effects)
        out << "  " << (effect.on ? "on " : "off") << "  " << std::left << std::setw(int(width)) << effect.name << "  "
            << effect.reason << '\n';
}

void writeEffects(const std::vector<Effect>& effects, const Statistics& statistics, JsonWriter& json) {
    json.beginArray("effects");
    for (const Effect& effect : effects) {
        json.beginObject();
        json.field("name", effect.name);
        json.field("on", effect.on);
        json.field("reason", effect.reason);
        json.field("causes", effect.causes);
        json.beginObject("counters");
        for (const std::string& counter : effect.counters) json.field(counter, statistics.counter(counter));
        json.endObject();
        json.endObject();
    }
    json.endArray();
}

void printDefaults(const std::vector<DefaultTaken>& defaults, std::ostream& out) {
    size_t width = 0;
    for (const DefaultTaken& taken : defaults) width = std::max(width, taken.field.size());
    if (!defaults.empty()) out << "what the scene leaves open\n";
    for (const DefaultTaken& taken : defaults)
        out << "  " << std::left << std::setw(int(width)) << taken.field << "  " << taken.value << " (" << taken.meaning
            << ")\n";
}

std::string planJson(const Job& job, const std::vector<DefaultTaken>& defaults) {
    JsonWriter json;
    json.field("scene", job.loaded.scene->file.string());
    json.field("integrator", job.loaded.integratorType);
    writeEffects(job.plan.effects, {}, json);
    json.field("lacks", job.plan.lacks);
    json.beginArray("defaults");
    for (const DefaultTaken& taken : defaults) {
        json.beginObject();
        json.field("field", taken.field);
        json.field("value", taken.value);
        json.field("meaning", taken.meaning);
        json.endObject();
    }
    json.endArray();
    return json.finish();
}

} // namespace tungsten
