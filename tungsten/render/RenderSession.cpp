#include "tungsten/render/RenderSession.h"

#include "tungsten/film/AtomicFile.h"
#include "tungsten/film/ImageIo.h"
#include "tungsten/render/HtmlPage.h"
#include "tungsten/render/Memory.h"
#include "tungsten/render/PassSizes.h"
#include "tungsten/render/Progress.h"
#include "tungsten/render/SceneFilm.h"
#include "tungsten/render/SessionFiles.h"

#include <bit>
#include <chrono>
#include <cstdio>
#include <thread>

namespace tungsten {

namespace {

using Clock = std::chrono::steady_clock;

/// Whether a target error is looked at after so many passes. Few passes know their own error badly, and every look is
/// another chance to stop at an estimate that happens to be low: looks are rare, each after twice the work.
bool checksError(uint32_t passes) {
    return passes >= LeastPassesForTargetError && std::has_single_bit(passes);
}

/// Keys of samples that are rendered in parts; whole ones come before.
constexpr uint64_t FirstPartialSample = uint64_t(1) << 31;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The state of one run of passes.
class Session {
  public:
    Session(const LoadedScene& loaded, Integrator& integrator, const OutputFiles& outputs,
            const SessionOptions& options, SessionResult& result)
        : loaded_(loaded), integrator_(integrator), outputs_(outputs), options_(options), result_(result),
          files_(loaded, outputs, options, result), firstPass_(options.passes ? options.passes->first : 0),
          spp_(samplesOf(options)), sizes_(spp_, uint64_t(options.sppStep), integrator.cutsLightPaths()),
          trace_(options.trace, *loaded.scene, options.seed), reporter_(options.quiet) {}

    void run(const EffectPlan& plan) {
        const Scene& scene = *loaded_.scene;
        if (options_.passes)
            checkWritable(partialState());
        else
            checkOutputs(outputs_, {scene.transport.gate.frames, options_.resumeEnabled,
                                    options_.checkpointSeconds > 0.0, loaded_.inputs});
        const bool bias = (options_.bias || options_.targetError > 0.0) && integrator_.leavesBias(plan);
        // Film, that of its bias, and one more copy of its images while they are written.
        requireMemory(loaded_, bias ? 3.0 : 2.0, integrator_.memoryBytes(), options_.memoryLimit);
        if (bias) result_.bias = filmOf(scene, PassWeight::Repeats);
        result_.film = filmOf(scene);
        files_.resume();
        result_.effects = plan.effects;
        black_ = plan.nothingArrives;
        if (!black_) {
            const StageTimer timer(result_.statistics, "prepare");
            integrator_.prepare(plan, result_.statistics);
        }
        if (stopBeforeFirstPass()) return;
        if (options_.passes) return renderPartially();
        renderPasses();
        if (result_.film.passes() > 0) files_.finish();
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
        try {
            writeAtomically(file, [&](std::ostream& out) {
                PartialStateWriter writer(out, file.string(), identity, firstPass_);
                partial_ = &writer;
                renderPasses();
                if (result_.film.passes() == 0) throw PassBrokenOff();
                writer.finish(statisticsJson(loaded_, options_, result_), processCpuSeconds());
            });
            result_.written = {file};
        } catch (const PassBrokenOff&) { // the first: no file
        }
    }

    /// Interrupted while loading: there is nothing to write.
    bool stopBeforeFirstPass() {
        if (interrupted()) result_.reason = StopReason::Interrupted;
        return interrupted();
    }

    void renderPasses() {
        const StageTimer timer(result_.statistics, "passes");
        start_ = Clock::now();
        trace_.start();
        bool stop = result_.samples >= spp_;
        while (!stop) {
            if (!renderOnePass()) {
                stop = afterBreak();
                continue;
            }
            if (options_.afterPass) options_.afterPass(result_);
            stop = shouldStop();
            trace_.record(result_.film, result_.bias, result_.samples);
            if (stop || reporter_.due()) reporter_.show(state(), stop);
            if (!stop) files_.checkpointIfDue();
        }
        result_.renderSeconds = secondsSince(start_);
        trace_.end(result_.film, result_.bias, result_.samples);
        result_.trace = trace_.entries();
    }

    /// False: it was broken off.
    bool renderOnePass() {
        const double done = result_.film.totalWeight();
        // A black image is there at once; partial states hold every pass all the same.
        const PassSize size = black_ && !partial_ ? sizes_.rest(done) : sizes_.next(done);
        const uint64_t before = firstPass_ * uint64_t(options_.sppStep);
        const uint32_t passes = result_.film.passes(),
                       standsFor = result_.estimatesBias() ? passesOfItsBias(passes) : 0;
        // Parts of one sample look at pixels in places of their own.
        const bool partial = size.weight < double(size.samples);
        const uint64_t firstSample = partial ? FirstPartialSample + passes : before + result_.samples;
        PassMonitor monitor([this] { return stopsPass(); });
        const PassInfo pass{firstPass_ + passes,
                            firstSample,
                            size.samples,
                            options_.seed,
                            standsFor > 0 ? &result_.bias : nullptr,
                            size.share,
                            PassWatch(monitor)};
        result_.film.beginPass();
        if (pass.bias) result_.bias.beginPass();
        const bool whole = tryPass(pass, monitor);
        if (failed_) std::rethrow_exception(failure_);
        if (!whole) return false;
        if (partial_) partial_->add(result_.film, size.samples);
        result_.film.endPass(size.weight);
        if (pass.bias) result_.bias.endPass(double(standsFor));
        result_.samples = uint64_t(result_.film.totalWeight());
        endedAPass_ = true;
        return true;
    }

    /// Figures of a pass that is broken off are left out, but for the time.
    bool tryPass(const PassInfo& pass, const PassMonitor& monitor) {
        monitor_ = &monitor;
        passStart_ = Clock::now();
        Statistics statistics;
        std::optional<StageTimer> timer(std::in_place, result_.statistics, "passes broken off");
        try {
            if (!black_) integrator_.renderPass(pass, result_.film, statistics);
            timer->discard();
        } catch (const PassBrokenOff&) {
            brokenAt_ = monitor.progress().ofPass;
            monitor_ = nullptr;
            return false;
        }
        monitor_ = nullptr;
        result_.statistics.add(statistics);
        return true;
    }

    /// Of a pass in progress; any of its threads.
    bool stopsPass() {
        if (std::this_thread::get_id() == thread_) showPass();
        return failed_.load(std::memory_order_relaxed) || interrupted() || secondsSince(begin_) >= deadline();
    }

    void showPass() {
        constexpr std::chrono::milliseconds Between(50);
        const auto now = Clock::now();
        if (now - lastShown_ < Between) return;
        lastShown_ = now;
        if (failed_) return;
        try {
            if (options_.duringPass) options_.duringPass();
        } catch (...) { // later: thrown here it would not end other threads' parts of the pass
            failure_ = std::current_exception();
            failed_ = true;
            return;
        }
        if (!reporter_.due()) return;
        const PassSize size = sizes_.next(result_.film.totalWeight());
        ProgressState progress = state();
        progress.pass = monitor_->progress();
        progress.samplesOfPass = size.weight;
        reporter_.show(progress, false);
    }

    /// Before a pass of this run has ended; a partial state has whole passes.
    [[nodiscard]] bool mayCut() const { return !endedAPass_ && !options_.passes && sizes_.canCut(); }

    /// When the pass in progress is to end, in seconds since begin_.
    [[nodiscard]] double deadline() const {
        if (options_.timeoutSeconds <= 0.0) return std::numeric_limits<double>::infinity();
        if (!mayCut()) return options_.timeoutSeconds;
        const double started = std::chrono::duration<double>(passStart_ - begin_).count();
        return std::min(options_.timeoutSeconds, started + FirstPassPart * options_.timeoutSeconds);
    }

    /// Whether the render ends with the pass that was broken off; else passes are smaller from now on.
    bool afterBreak() {
        if (interrupted() || secondsSince(begin_) >= options_.timeoutSeconds) {
            result_.reason = interrupted() ? StopReason::Interrupted : StopReason::TimedOut;
            return true;
        }
        sizes_.cut(brokenAt_);
        std::fprintf(stderr, "warning: %s: the first pass did not end within %.3g s, a quarter of the time-out: %s\n",
                     loaded_.diagnostics->file.c_str(), FirstPassPart * options_.timeoutSeconds, sizes_.text().c_str());
        return false;
    }

    [[nodiscard]] bool interrupted() const { return options_.interrupted && options_.interrupted->load(); }

    bool shouldStop() {
        const auto because = [&](StopReason reason) {
            result_.reason = reason;
            return true;
        };
        if (result_.samples >= spp_) return because(StopReason::Finished);
        if (interrupted()) return because(StopReason::Interrupted);
        if (options_.timeoutSeconds > 0.0 && secondsSince(begin_) >= options_.timeoutSeconds)
            return because(StopReason::TimedOut);
        if (options_.targetError <= 0.0 || !checksError(result_.film.passes())) return false;
        return result_.errorBound() <= options_.targetError && because(StopReason::TargetReached);
    }

    /// Costs a sweep over the film (the standard error): made only when it is shown.
    [[nodiscard]] ProgressState state() const {
        ProgressState progress;
        progress.passes = result_.film.passes();
        progress.totalPasses = progress.passes + sizes_.left(result_.film.totalWeight());
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
    SessionFiles files_;
    uint32_t firstPass_;
    uint64_t spp_; ///< of this session
    PassSizes sizes_;
    std::atomic<bool> failed_{false};
    std::exception_ptr failure_;           ///< of duringPass, if failed_
    bool endedAPass_ = false;              ///< in this run
    const PassMonitor* monitor_ = nullptr; ///< of the pass in progress
    double brokenAt_ = 0.0;                ///< where the last pass that was broken off was
    std::thread::id thread_ = std::this_thread::get_id();
    Clock::time_point begin_ = Clock::now(), passStart_ = begin_, lastShown_ = begin_;
    PartialStateWriter* partial_ = nullptr;
    bool black_ = false; ///< nothing arrives: no pass is rendered
    Trace trace_;
    ProgressReporter reporter_;
    Clock::time_point start_;
};

} // namespace

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
