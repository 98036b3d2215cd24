#pragma once
// What a session reads and writes: images, checkpoints, the state that it resumes from.

#include "tungsten/render/Checkpoint.h"
#include "tungsten/render/RenderSession.h"

#include <chrono>

namespace tungsten {

class SessionFiles {
  public:
    SessionFiles(const LoadedScene& loaded, const OutputFiles& outputs, const SessionOptions& options,
                 SessionResult& result)
        : loaded_(loaded), outputs_(outputs), options_(options),
          result_(result), identity_{loaded.hash, options.seed, options.sppStep} {}

    /// Loads the saved films, if there are any. Throws what readCheckpoint throws.
    void resume();
    /// Images and state once more, if it is time; what goes wrong is a warning.
    void checkpointIfDue();
    [[nodiscard]] bool checkpointDue() const;
    /// All of the result but statistics and page. Throws InputError of everything that could not be written.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;

    void warnAboutTarget() const;
    std::vector<Problem> write(const std::string& suffix);

    const LoadedScene& loaded_;
    const OutputFiles& outputs_;
    const SessionOptions& options_;
    SessionResult& result_;
    RenderIdentity identity_;
    Clock::time_point lastCheckpoint_ = Clock::now();
};

} // namespace tungsten
