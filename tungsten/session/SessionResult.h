#pragma once
// What a session is asked for, and what comes of it.

#include "tungsten/film/Film.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/integrator/Features.h"
#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/integrator/Statistics.h"
#include "tungsten/session/PartialState.h"
#include "tungsten/session/Trace.h"

#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tungsten {

class ProcessGroup;
struct SessionResult;

enum class StopReason { Finished, TimedOut, TargetReached, Interrupted };
std::string toString(StopReason reason);

struct SessionOptions {
    uint64_t seed = 0xBA5EBA11u;
    int64_t spp = 32, sppStep = 16;
    std::optional<PassRange> passes; ///< of the render; they go into a partial state, and no images are written
    double timeoutSeconds = 0.0;     ///< of preparing and rendering; 0: none
    double checkpointSeconds = 0.0;  ///< 0: none
    bool resumeEnabled = false;      ///< write and read the state file
    bool restart = false;            ///< ignore a saved state
    double targetError = 0.0;        ///< stop when SessionResult::errorBound() is at most this; 0: none
    bool bias = false;               ///< estimate what kernels leave; a target error does, too
    double memoryLimit = 0.0;        ///< bytes; 0: what the machine has available
    bool quiet = false;              ///< no progress bar
    std::filesystem::path trace;     ///< folder of the render's trace; empty: none
    std::string command;             ///< that started the render, for its page
    ProcessGroup* group = nullptr;   ///< of this process; rank 0 writes
    const std::atomic<bool>* interrupted = nullptr; ///< set by Ctrl-C: break the pass off, write, stop
    /// Called after every pass, before it is decided whether to go on. What it throws ends the render.
    std::function<void(const SessionResult&)> afterPass;
    /// Called some twenty times a second within passes, by the thread that renders. What it throws ends the render.
    std::function<void()> duringPass;
};

struct SessionResult {
    StopReason reason = StopReason::Finished;
    Film film;
    Film bias; ///< by pixel, of measured passes; without pixels where none is estimated
    Statistics statistics;
    double renderSeconds = 0.0;    ///< passes of this run, not counting loading and writing
    uint64_t samples = 0;          ///< whole ones per pixel, resumed ones included
    uint64_t resumedSamples = 0;   ///< of them, taken by earlier runs
    int ranks = 1;                 ///< of the group that rendered
    double othersCpuSeconds = 0.0; ///< of ranks but the first
    double othersPeakMemory = 0.0; ///< bytes: the largest of them
    PassProgress brokenOff;        ///< where the preparing, or the pass, was that was broken off last
    std::vector<TraceEntry> trace; ///< where one is written
    std::vector<std::filesystem::path> written;
    std::vector<Feature> features;

    [[nodiscard]] bool estimatesBias() const { return bias.frames() > 0; }
    /// Of the film's mean; 0 where none is estimated.
    [[nodiscard]] RelativeBias relativeBias() const {
        return estimatesBias() ? RelativeBias::of(film, bias) : RelativeBias{0.0, 0.0};
    }
    /// Of noise and bias together, relative; what the error does not exceed with a confidence of 95 %. NaN: unknown.
    [[nodiscard]] double errorBound() const { return std::hypot(relativeErrorBound(film), relativeBias().bound); }
};

} // namespace tungsten
