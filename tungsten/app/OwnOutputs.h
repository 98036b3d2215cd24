#pragma once
// Scenes of one command that would write the same files.

#include "tungsten/app/Options.h"

namespace tungsten {

/// Throws UsageError if two scenes would write the same file: the later would replace the earlier's, or resume it.
void requireOutputsOfTheirOwn(const Options& options);

} // namespace tungsten
