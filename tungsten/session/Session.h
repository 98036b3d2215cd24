#pragma once
// Runs an integrator pass by pass: progress, standard error, time-outs, checkpoints, outputs.

#include "tungsten/integrator/Integrator.h"
#include "tungsten/io/Outputs.h"
#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/SessionResult.h"

namespace tungsten {

/// A target error is first looked at after so many passes, then whenever their number has doubled.
inline constexpr uint32_t LeastPassesForTargetError = 16;

/// Renders and writes every output. A pass that a time-out or an interrupt finds in progress is broken off: the film
/// holds whole passes alone. Where not one has ended, nothing is written. Facts and features are complete
/// (Integrator::plan was called). Throws InputError before the first pass when an output cannot be written. In a group
/// every rank calls this alike; the film is whole in rank 0, which alone writes, and what keeps any rank from starting
/// is a GroupFailure.
void runSession(const LoadedScene& loaded, Integrator& integrator, const SceneFacts& facts, const Features& features,
                const OutputFiles& outputs, const SessionOptions& options, SessionResult& result);

} // namespace tungsten
