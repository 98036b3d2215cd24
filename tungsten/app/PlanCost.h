#pragma once
// `tungsten --plan-cost`: what an error costs by each method.

#include "tungsten/app/Options.h"
#include "tungsten/session/Job.h"

#include <atomic>

namespace tungsten {

/// Renders a pilot of every method, prints a table from errors to seconds, and writes it as JSON where --stats names a
/// file. A method that cannot render the scene is listed with the reason. Throws InputError if none can, or if the
/// scene cannot be read. False: it was interrupted, and nothing is printed.
bool planCost(const std::filesystem::path& file, const Options& options, const Plugins& plugins,
              const std::atomic<bool>& interrupted);

} // namespace tungsten
