#pragma once
// Which files a render writes, and writing them.

#include "tungsten/film/Film.h"
#include "tungsten/scene/SceneLoader.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace tungsten {

/// Where results go; relative paths are relative to the process directory.
struct OutputFiles {
    std::filesystem::path ldr;        ///< PNG, always written
    std::filesystem::path hdr;        ///< .exr, .pfm or .npy; empty: none
    std::vector<OutputBuffer> colors; ///< further files of the image, the LDR ones not tone-mapped (resolved names)
    std::vector<OutputBuffer> series; ///< per-frame files of sequences (resolved names)
    std::filesystem::path state;      ///< resume state
    std::filesystem::path statistics; ///< JSON; empty: none
};

/// What the command line says about files (-d, -o, -e, --stats).
struct OutputOverrides {
    std::optional<std::filesystem::path> directory, ldr, hdr, statistics;
};

/// File names of a scene: the renderer block's, resolved against its output directory, unless the command line says
/// otherwise. `overwrite_output_files` false picks names that are free.
OutputFiles resolveOutputs(const RendererSettings& renderer, const std::filesystem::path& sceneFile,
                           const OutputOverrides& overrides);

/// Creates missing folders and throws InputError if an output (with `withState` the resume state too) could not be
/// written or has an unknown extension.
void checkOutputs(const OutputFiles& outputs, bool withState = false);

/// Writes every image of the film and returns the files' names; with a `suffix` (which goes before the extension:
/// checkpoints) only the main ones. Throws InputError after trying all of them if any failed.
std::vector<std::filesystem::path> writeImages(const Film& film, const Scene& scene, const OutputFiles& outputs,
                                               const std::string& suffix = "");

} // namespace tungsten
