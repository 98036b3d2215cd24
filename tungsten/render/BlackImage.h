#pragma once
// What is said of a render that has found no light.

#include "tungsten/render/EffectPlan.h"
#include "tungsten/render/RenderSession.h"

#include <optional>

namespace tungsten {

/// A warning if every pixel of the film is 0 after at least one pass, with what may be the cause; none if the plan has
/// said before that nothing can arrive.
std::optional<Problem> blackImage(const Scene& scene, const EffectPlan& plan, const SessionResult& result);

} // namespace tungsten
