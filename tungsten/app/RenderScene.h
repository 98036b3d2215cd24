#pragma once
// One scene of the command: loaded, then explained, priced or rendered.

#include "tungsten/app/Options.h"
#include "tungsten/session/Job.h"
#include "tungsten/session/ProcessGroup.h"

namespace tungsten {

/// Whether this process tells what happens: one without others, and rank 0.
inline bool isRoot(const ProcessGroup* group) {
    return !group || group->rank() == 0;
}

void printWarnings(const std::vector<Problem>& warnings, size_t more = 0);

/// Exit code: 0, or 130 when interrupted before there was anything to write. Throws what keeps the scene from being
/// rendered.
int renderScene(const std::filesystem::path& file, const Options& options, const Plugins& plugins, ProcessGroup* group);

} // namespace tungsten
