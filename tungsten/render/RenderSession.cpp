#include "tungsten/render/RenderSession.h"

#include "tungsten/film/AtomicFile.h"
#include "tungsten/film/ImageIo.h"
#include "tungsten/render/Checkpoint.h"
#include "tungsten/render/HtmlPage.h"
#include "tungsten/render/Memory.h"
#include "tungsten/render/Progress.h"
#include "tungsten/render/ResultDescription.h"
#include "tungsten/render/SceneFilm.h"

#include <bit>
#include <chrono>
#include <cstdio>

namespace tungsten {

namespace {

using Clock = std::chrono::steady_clock;

/// Whether a target error is looked at after so many passes. Few passes know their own error badly, and every look is
/// another chance to stop at an estimate that happens to be low: looks are rare, each after twice the work.
bool checksError(uint32_t passes) {
    return passes >= LeastPassesForTargetError && std::has_single_bit(passes);
}

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The state of one run of passes.
class Session {
  public:
    Session(const LoadedScene& loaded, Integrator& integrator, const OutputFiles& outputs,
            const SessionOptions& options, SessionResult& result)
        : loaded_(loaded), integrator_(integrator), outputs_(outputs), options_(options),
          result_(result), identity_{loaded.hash, options.seed, options.sppStep},
          firstPass_(options.passes ? options.passes->first : 0), spp_(samplesOf(options)),
          trace_(options.trace, *loaded.scene, options.seed), reporter_(options.quiet) {}

    void run(const EffectPlan& plan) {
        const Scene& scene = *loaded_.scene;
        if (options_.passes)
            checkWritable(partialState());
        else
            checkOutputs(outputs_, {scene.transport.gate.frames, options_.resumeEnabled,
                                    options_.checkpointSeconds > 0.0, loaded_.inputs});
        const bool bias = (options_.bias || options_.targetError > 0.0) && integrator_.leavesBias(plan);
        requireMemory(bias ? 3.0 : 2.0);
        if (bias) result_.bias = filmOf(scene, PassWeight::Repeats);
        result_.film = filmOf(scene);
        resume();
        result_.effects = plan.effects;
        black_ = plan.nothingArrives;
        if (!black_) {
            const StageTimer timer(result_.statistics, "prepare");
            integrator_.prepare(plan, result_.statistics);
        }
        if (stopBeforeFirstPass()) return;
        if (options_.passes) return renderPartially();
        renderPasses();
        finish();
    }

  private:
    /// Samples per pixel of this session. Throws UsageError for passes that the render does not have.
    static uint64_t samplesOf(const SessionOptions& options) {
        const auto spp = uint64_t(options.spp), step = uint64_t(options.sppStep);
        if (!options.passes) return spp;
        const uint64_t passes = (spp + step - 1) / step;
        const auto [first, end] = *options.passes;
        if (end > passes)
            throw UsageError("--passes " + std::to_string(first) + ":" + std::to_string(end) + ": the render has " +
                             std::to_string(passes) + " passes, from 0, of " + std::to_string(spp) +
                             " samples per pixel in steps (spp_step) of " + std::to_string(step));
        return std::min(spp, end * step) - first * step;
    }
    [[nodiscard]] std::filesystem::path partialState() const {
        return outputs_.partialState(options_.passes->first, options_.passes->end);
    }

    /// Every pass goes to the file as soon as it is there.
    void renderPartially() {
        const std::filesystem::path file = partialState();
        const PartialIdentity identity = PartialIdentity::of(loaded_, options_.seed, options_.sppStep);
        writeAtomically(file, [&](std::ostream& out) {
            PartialStateWriter writer(out, file.string(), identity, firstPass_);
            partial_ = &writer;
            renderPasses();
            writer.finish(statisticsJson(loaded_, options_, result_), processCpuSeconds());
        });
        result_.written = {file};
    }

    /// Film, that of its bias, one more copy of its images while they are written (`films` in all), and what the
    /// integrator says.
    void requireMemory(double films) const {
        const Camera& camera = loaded_.scene->camera;
        const int frames = loaded_.scene->transport.gate.frames;
        const double film = films * filmMemoryOf(*loaded_.scene);
        const double tables = integrator_.memoryBytes();
        const double limit = options_.memoryLimit > 0.0 ? options_.memoryLimit : availableMemoryBytes();
        if (film + tables <= limit) return;
        throw InputError(loaded_.diagnostics->file,
                         "needs about " + memoryText(film + tables) + " of memory (" + memoryText(film) + " for " +
                             std::to_string(camera.resolution.x) + "x" + std::to_string(camera.resolution.y) +
                             " pixels in " + std::to_string(frames) + " frames, " + memoryText(tables) +
                             " for the integrator), " +
                             (options_.memoryLimit > 0.0 ? "--memory-limit is " : "there are ") + memoryText(limit) +
                             "; use fewer frames, photons or a smaller --resolution");
    }

    void resume() {
        if (!options_.resumeEnabled || options_.restart) return;
        if (const auto point = readCheckpoint(outputs_.state, identity_, result_.film, result_.bias))
            result_.samples = point->samples;
        result_.resumedSamples = result_.samples;
        if (result_.samples > 0 && !options_.quiet)
            std::fprintf(stderr, "resuming after %llu samples per pixel from %s\n",
                         static_cast<unsigned long long>(result_.samples), outputs_.state.c_str());
    }

    /// Interrupted while loading: there is nothing to write.
    bool stopBeforeFirstPass() {
        const bool stop = options_.interrupted && options_.interrupted->load();
        if (stop) result_.reason = StopReason::Interrupted;
        return stop;
    }

    void renderPasses() {
        const StageTimer timer(result_.statistics, "passes");
        start_ = lastCheckpoint_ = Clock::now();
        trace_.start();
        bool stop = result_.samples >= spp_;
        while (!stop) {
            renderOnePass();
            if (options_.afterPass) options_.afterPass(result_);
            stop = shouldStop();
            trace_.record(result_.film, result_.bias, result_.samples, stop);
            if (stop || reporter_.due()) reporter_.show(state(), stop);
            if (!stop) checkpointIfDue();
        }
        result_.renderSeconds = secondsSince(start_);
        result_.trace = trace_.entries();
    }

    void renderOnePass() {
        const uint64_t left = spp_ - result_.samples, before = firstPass_ * uint64_t(options_.sppStep);
        // A black image is there at once; partial states hold every pass all the same.
        const bool atOnce = black_ && !partial_;
        const auto samples = uint32_t(std::min(atOnce ? uint64_t(UINT32_MAX) : uint64_t(options_.sppStep), left));
        const uint32_t done = result_.film.passes(), standsFor = result_.estimatesBias() ? passesOfItsBias(done) : 0;
        const PassInfo pass{firstPass_ + done, before + result_.samples, samples, options_.seed,
                            standsFor > 0 ? &result_.bias : nullptr};
        result_.film.beginPass();
        if (pass.bias) result_.bias.beginPass();
        if (!black_) integrator_.renderPass(pass, result_.film, result_.statistics);
        if (partial_) partial_->add(result_.film, samples);
        result_.film.endPass(double(samples));
        if (pass.bias) result_.bias.endPass(double(standsFor));
        result_.samples += samples;
    }

    bool shouldStop() {
        const auto because = [&](StopReason reason) {
            result_.reason = reason;
            return true;
        };
        if (result_.samples >= spp_) return because(StopReason::Finished);
        if (options_.interrupted && options_.interrupted->load()) return because(StopReason::Interrupted);
        if (options_.timeoutSeconds > 0.0 && secondsSince(start_) >= options_.timeoutSeconds)
            return because(StopReason::TimedOut);
        if (options_.targetError <= 0.0 || !checksError(result_.film.passes())) return false;
        return result_.errorBound() <= options_.targetError && because(StopReason::TargetReached);
    }

    void checkpointIfDue() {
        if (options_.checkpointSeconds <= 0.0 || secondsSince(lastCheckpoint_) < options_.checkpointSeconds) return;
        const StageTimer timer(result_.statistics, "checkpoint");
        // The images so far are worth more than the checkpoint: the render goes on.
        for (const Problem& problem : write(CheckpointSuffix))
            std::fprintf(stderr, "warning: checkpoint: %s\n", problem.text().c_str());
        lastCheckpoint_ = Clock::now();
    }

    void finish() {
        const StageTimer timer(result_.statistics, "write");
        const std::vector<Problem> problems = write("");
        if (!problems.empty()) throw InputError(problems);
    }

    /// Images and state; a failure of one does not keep the other from being written.
    std::vector<Problem> write(const std::string& suffix) {
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

    /// Costs a sweep over the film (the standard error): made only when it is shown.
    [[nodiscard]] ProgressState state() const {
        const uint64_t left = spp_ - std::min(result_.samples, spp_);
        const uint64_t step = uint64_t(options_.sppStep);
        ProgressState progress;
        progress.passes = result_.film.passes();
        progress.totalPasses = progress.passes + uint32_t((left + step - 1) / step);
        progress.samples = int64_t(result_.samples);
        progress.totalSamples = int64_t(spp_);
        progress.elapsedSeconds = secondsSince(start_);
        progress.timeoutSeconds = options_.timeoutSeconds;
        progress.relativeError = result_.film.relativeStandardError();
        progress.errorBound = result_.film.relativeErrorBound();
        progress.bias = result_.relativeBias();
        progress.targetError = options_.targetError;
        progress.resumedSamples = int64_t(result_.resumedSamples);
        return progress;
    }

    const LoadedScene& loaded_;
    Integrator& integrator_;
    const OutputFiles& outputs_;
    const SessionOptions& options_;
    SessionResult& result_;
    RenderIdentity identity_;
    uint32_t firstPass_;
    uint64_t spp_; ///< of this session
    PartialStateWriter* partial_ = nullptr;
    bool black_ = false; ///< nothing arrives: no pass is rendered
    Trace trace_;
    ProgressReporter reporter_;
    Clock::time_point start_, lastCheckpoint_;
};

} // namespace

std::string toString(StopReason reason) {
    switch (reason) {
    case StopReason::Finished:
        return "all samples taken";
    case StopReason::TimedOut:
        return "time-out";
    case StopReason::TargetReached:
        return "target error reached";
    case StopReason::Interrupted:
        return "interrupted";
    }
    return "";
}

void runSession(const LoadedScene& loaded, Integrator& integrator, const EffectPlan& plan, const OutputFiles& outputs,
                const SessionOptions& options, SessionResult& result) {
    Session(loaded, integrator, outputs, options, result).run(plan);
    if (result.film.passes() == 0) return;
    if (!outputs.statistics.empty()) {
        makeFolderOf(outputs.statistics);
        writeTextFile(outputs.statistics, statisticsJson(loaded, options, result));
        result.written.push_back(outputs.statistics);
    }
    if (!outputs.page.empty()) {
        makeFolderOf(outputs.page);
        writeFilmPage(outputs.page, loaded, options, result);
        result.written.push_back(outputs.page);
    }
}

} // namespace tungsten
