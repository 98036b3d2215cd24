#pragma once
// The resume state: everything a render needs to go on as if it had never stopped.

#include "tungsten/film/Film.h"

#include <filesystem>
#include <optional>

namespace tungsten {

/// What must agree between a saved state and the render that resumes it.
struct RenderIdentity {
    uint64_t sceneHash = 0;
    uint64_t seed = 0;
    int64_t sppStep = 0;
};

/// Progress of a resumed render.
struct ResumePoint {
    uint64_t samples = 0; ///< per pixel
};

void writeCheckpoint(const std::filesystem::path& file, const RenderIdentity& identity, const ResumePoint& point,
                     const Film& film);
/// Loads the film; none if there is no such file. Throws InputError if the state belongs to another render or is
/// damaged.
std::optional<ResumePoint> readCheckpoint(const std::filesystem::path& file, const RenderIdentity& identity,
                                          Film& film);

} // namespace tungsten
