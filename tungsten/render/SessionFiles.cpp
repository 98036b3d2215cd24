#include "tungsten/render/SessionFiles.h"

#include "tungsten/film/ImageIo.h"
#include "tungsten/render/ResultDescription.h"

#include <cstdio>

namespace tungsten {

void SessionFiles::resume() {
    if (!options_.resumeEnabled || options_.restart) return;
    if (const auto point = readCheckpoint(outputs_.state, identity_, result_.film, result_.bias))
        result_.samples = point->samples;
    result_.resumedSamples = result_.samples;
    if (result_.samples > 0 && !options_.quiet)
        std::fprintf(stderr, "resuming after %llu samples per pixel from %s\n",
                     static_cast<unsigned long long>(result_.samples), outputs_.state.c_str());
}

bool SessionFiles::checkpointDue() const {
    return options_.checkpointSeconds > 0.0 &&
           Clock::now() - lastCheckpoint_ >= std::chrono::duration<double>(options_.checkpointSeconds);
}

void SessionFiles::checkpointIfDue() {
    if (!checkpointDue()) return;
    const StageTimer timer(result_.statistics, "checkpoint");
    // The images so far are worth more than the checkpoint: the render goes on.
    for (const Problem& problem : write(CheckpointSuffix))
        std::fprintf(stderr, "warning: checkpoint: %s\n", problem.text().c_str());
    lastCheckpoint_ = Clock::now();
}

/// Only the samples have come to an end, and nobody may have thought of them.
void SessionFiles::warnAboutTarget() const {
    if (options_.targetError <= 0.0 || result_.reason != StopReason::Finished ||
        result_.errorBound() <= options_.targetError)
        return;
    std::fprintf(stderr,
                 "warning: %s: the target error of %.3g %% was not reached: %lld samples per pixel, the scene's spp or "
                 "--spp, ended the render before; a larger --spp lets it go on\n",
                 loaded_.diagnostics->file.c_str(), 100.0 * options_.targetError, static_cast<long long>(options_.spp));
}

void SessionFiles::finish() {
    warnAboutTarget();
    const StageTimer timer(result_.statistics, "write");
    const std::vector<Problem> problems = write("");
    if (!problems.empty()) throw InputError(problems);
}

/// Images and state; a failure of one does not keep the other from being written.
std::vector<Problem> SessionFiles::write(const std::string& suffix) {
    std::vector<Problem> problems;
    const auto attempt = [&](const auto& action) {
        try {
            action();
        } catch (const InputError& error) {
            problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        }
    };
    attempt([&] {
        const std::string metadata = describeResult({*loaded_.scene, loaded_.integratorType, loaded_.text,
                                                     options_.command, statisticsJson(loaded_, options_, result_)});
        auto files = writeImages(result_.film, result_.bias, *loaded_.scene, outputs_, metadata, suffix);
        if (suffix.empty()) result_.written = std::move(files);
    });
    if (options_.resumeEnabled)
        attempt([&] {
            makeFolderOf(outputs_.state);
            writeCheckpoint(outputs_.state, identity_, {result_.samples}, result_.film, result_.bias);
        });
    return problems;
}

} // namespace tungsten
