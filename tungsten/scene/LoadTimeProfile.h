#pragma once
// Reading densities over time.

#include "tungsten/core/TimeProfile.h"
#include "tungsten/reader/ObjectReader.h"

namespace tungsten {

/// The block `field` of `reader`: tabulated, or a shape by its name. Empty where there is none, or a mistake, which
/// becomes a problem.
TimeProfile readTimeProfile(const ObjectReader& reader, const std::string& field, const Meaning& meaning);

} // namespace tungsten
