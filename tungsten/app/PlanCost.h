#pragma once
// `tungsten --plan-cost`: what an error costs by each method.

#include "tungsten/app/Options.h"
#include "tungsten/render/Job.h"

namespace tungsten {

/// Renders a pilot of every method, prints a table from errors to seconds, and writes it as JSON where --stats names a
/// file. A method that cannot render the scene is listed with the reason. Throws InputError if none can, or if the
/// scene cannot be read.
void planCost(const std::filesystem::path& file, const Options& options, const Plugins& plugins);

} // namespace tungsten
