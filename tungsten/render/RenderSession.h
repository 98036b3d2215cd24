#pragma once
// Runs an integrator pass by pass: progress, standard error, time-outs, checkpoints, outputs.

#include "tungsten/render/Integrator.h"
#include "tungsten/scene/SceneLoader.h"

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tungsten {

/// Where results go; absolute or relative to the process directory.
struct OutputFiles {
    std::filesystem::path ldr;  ///< PNG
    std::filesystem::path hdr;  ///< .exr, .pfm or .npy; empty: none
    std::vector<TransientsBuffer> series; ///< per-frame files (resolved names)
    std::filesystem::path state;          ///< resume state
    std::filesystem::path statistics;     ///< JSON; empty: none
};

/// File names of a scene: -d, -o and -e against the renderer block; `overwrite_output_files` false picks free names.
struct OutputOverrides {
    std::optional<std::filesystem::path> directory, ldr, hdr, statistics;
};
OutputFiles resolveOutputs(const RendererSettings& renderer, const std::filesystem::path& sceneFile,
                           const OutputOverrides& overrides);

struct SessionOptions {
    uint64_t seed = 0xBA5EBA11u;
    int64_t spp = 32, sppStep = 16;
    double timeoutSeconds = 0.0;    ///< 0: none
    double checkpointSeconds = 0.0; ///< 0: none
    bool resumeEnabled = false;     ///< write and read the state file
    bool restart = false;           ///< ignore a saved state
    double targetError = 0.0;       ///< stop when the relative standard error is below; 0: none
    bool quiet = false;             ///< no progress bar
    const std::atomic<bool>* interrupted = nullptr; ///< set by Ctrl-C: finish the pass, write, stop
};

enum class StopReason { Finished, TimedOut, TargetReached, Interrupted };

struct SessionResult {
    StopReason reason = StopReason::Finished;
    Film film;
    Statistics statistics;
    double renderSeconds = 0.0;
    std::vector<std::filesystem::path> written;
};

/// Renders and writes every output. Throws InputError before the first pass when an output cannot be written.
void runSession(const LoadedScene& loaded, Integrator& integrator, EffectPlan& plan, const OutputFiles& outputs,
                const SessionOptions& options, SessionResult& result);

} // namespace tungsten
