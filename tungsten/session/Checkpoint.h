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

/// `bias` is the film's, without frames where none is estimated.
void writeCheckpoint(const std::filesystem::path& file, const RenderIdentity& identity, const ResumePoint& point,
                     const Film& film, const Film& bias);
/// Loads the films; none if there is no such file. Throws InputError if the state belongs to another render, one that
/// estimates a bias or does not as `bias` has it, or is damaged.
std::optional<ResumePoint> readCheckpoint(const std::filesystem::path& file, const RenderIdentity& identity, Film& film,
                                          Film& bias);

} // namespace tungsten
