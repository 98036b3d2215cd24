#pragma once
// The plan for readers: text for `--explain`, JSON for `--explain=json` and `--stats`.

#include "tungsten/render/DefaultsTaken.h"
#include "tungsten/render/Statistics.h"
#include "tungsten/scene/JsonWriter.h"

#include <iosfwd>

namespace tungsten {

/// What is sampled how, in three lines; then what the image lacks and what is left out, with reasons.
void printPlan(const EffectPlan& plan, std::ostream& out);
/// Every effect, on or off, with its reason.
void printEffects(const EffectPlan& plan, std::ostream& out);
/// What the scene leaves open, below a heading; nothing where it leaves nothing.
void printDefaults(const std::vector<DefaultTaken>& defaults, std::ostream& out);
/// An array `effects`: name, on, reason, causes and counters with what they have reached.
void writeEffects(const std::vector<Effect>& effects, const Statistics& statistics, JsonWriter& json);
/// Scene, integrator, `sampling`, `effects`, `lacks` and `defaults`; nothing has been counted.
std::string planJson(const Job& job, const std::vector<DefaultTaken>& defaults);

} // namespace tungsten
