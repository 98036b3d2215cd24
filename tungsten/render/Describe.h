#pragma once
// All that a scene can say, integrators of plugins included: the declarations of every field, by type.

#include "tungsten/render/Integrator.h"
#include "tungsten/scene/SceneLoader.h"

namespace tungsten {

/// The kinds of `--list`, and "blocks": the objects of a scene that have no type, such as `renderer` and `darts`.
std::vector<DescribedKind> describeAll(const IntegratorRegistry& registry);

/// What `name` means, a type or a kind; everything if it is empty. Throws UsageError with the nearest name.
std::vector<DescribedKind> selectDescriptions(const std::vector<DescribedKind>& all, const std::string& name);

} // namespace tungsten
