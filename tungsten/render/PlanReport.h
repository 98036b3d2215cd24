#pragma once
// The plan for readers: text for `--explain`, JSON for `--explain=json` and `--stats`.

#include "tungsten/render/EffectPlan.h"
#include "tungsten/render/Statistics.h"
#include "tungsten/scene/JsonWriter.h"

#include <iosfwd>

namespace tungsten {

void printPlan(const EffectPlan& plan, std::ostream& out);
/// An array `effects`: name, on, reason, causes and counters with what they have reached.
void writeEffects(const std::vector<Effect>& effects, const Statistics& statistics, JsonWriter& json);
/// Scene, integrator, `effects` and `lacks`; nothing has been counted.
std::string planJson(const Scene& scene, const std::string& integrator, const EffectPlan& plan);

} // namespace tungsten
