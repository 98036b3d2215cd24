#pragma once
// The answer to `--list`.

#include "tungsten/integrator/Integrator.h"

#include <iosfwd>

namespace tungsten {

/// Integrators with their origin, then every type name a scene can use.
void printTypes(const IntegratorRegistry& registry, std::ostream& out);

} // namespace tungsten
