#include "tungsten/render/PlanReport.h"

#include "tungsten/render/BounceCuts.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <ostream>

namespace tungsten {

void EffectPlan::count(const std::string& effect, const std::vector<std::string>& counters) {
    for (Effect& described : effects)
        if (described.name == effect)
            described.counters.insert(described.counters.end(), counters.begin(), counters.end());
}

namespace {

/// Whether the effect is that of leaving something out, and does.
bool leavesOut(const Effect& effect, const EffectPlan& plan) {
    const bool surfaces = plan.surfaceScattering || plan.surfaceEmission || plan.specularSensorPaths;
    if (effect.name == "surfaces in time") return surfaces && plan.surfacesOutOfTime;
    if (effect.name == "media in time") return !plan.mediaOutOfTime.empty();
    constexpr std::array LeftOut{"late emitters left out", "black image", "frames before all light", LightCut};
    return effect.on && std::ranges::find(LeftOut, effect.name) != LeftOut.end();
}

} // namespace

void printPlan(const EffectPlan& plan, std::ostream& out) {
    out << "  paths     " << plan.sampling.paths << "\n  vertices  " << plan.sampling.vertices << "\n  ends      "
        << plan.sampling.ends << '\n';
    for (const std::string& lack : plan.lacks) out << "  lacks     " << lack << '\n';
    for (const Effect& effect : plan.effects)
        if (leavesOut(effect, plan)) out << "  left out  " << effect.name << ": " << effect.reason << '\n';
}

void printEffects(const EffectPlan& plan, std::ostream& out) {
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
    json.beginObject("sampling");
    json.field("paths", job.plan.sampling.paths);
    json.field("vertices", job.plan.sampling.vertices);
    json.field("ends", job.plan.sampling.ends);
    json.endObject();
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
