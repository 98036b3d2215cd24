#include "tungsten/session/Session.h"

#include "tungsten/image/AtomicFile.h"
#include "tungsten/io/Page.h"
#include "tungsten/io/Result.h"
#include "tungsten/session/Checkpoint.h"
#include "tungsten/session/Job.h"
#include "tungsten/session/Memory.h"
#include "tungsten/session/Passes.h"
#include "tungsten/session/Progress.h"
#include "tungsten/session/Report.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstdio>
#include <exception>
#include <functional>
#include <optional>
#include <thread>

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

/// How long preparing and rendering may take, from when the session begins.
class TimeLimit {
  public:
    /// 0 seconds: none.
    explicit TimeLimit(double seconds) : seconds_(seconds) {}

    [[nodiscard]] bool isOver() const { return seconds_ > 0.0 && Clock::now() >= end(); }
    [[nodiscard]] Clock::time_point end() const {
        return seconds_ > 0.0 ? after(begin_, seconds_) : Clock::time_point::max();
    }
    /// When a first pass that begins now, and that may be cut (PassSizes), is broken off.
    [[nodiscard]] Clock::time_point endOfFirstPass() const {
        return seconds_ > 0.0 ? std::min(end(), after(Clock::now(), firstPassSeconds())) : end();
    }
    [[nodiscard]] double firstPassSeconds() const { return FirstPassPart * seconds_; }

  private:
    static constexpr double FirstPassPart = 0.25;

    static Clock::time_point after(Clock::time_point start, double seconds) {
        constexpr double Ever = 1e9; // the clock counts nanoseconds in 64 bits
        return start +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, Ever)));
    }

    double seconds_;
    Clock::time_point begin_ = Clock::now();
};

/// Renders passes until they end, are interrupted, are out of time, or what is called meanwhile throws.
class PassRunner {
  public:
    /// Keeps the references. `show` is called some twenty times a second within passes, by the thread that made this.
    PassRunner(const SessionOptions& options, SessionResult& result, std::function<void(const ProgressMonitor&)> show)
        : options_(options), result_(result), show_(std::move(show)) {}

    /// `render` renders what it is given: the pass, with a watch. False: it was broken off, and its figures are left
    /// out, but for the time.
    bool run(PassInfo pass, Clock::time_point end, const std::function<void(const PassInfo&, Statistics&)>& render);

    /// Part of the last pass that was broken off which had been rendered.
    [[nodiscard]] double brokenAt() const { return result_.brokenOff.ofPass; }
    [[nodiscard]] bool interrupted() const { return options_.interrupted && options_.interrupted->load(); }
    /// What SessionOptions::duringPass has thrown: later, since within a pass it would not end other threads' parts.
    void rethrow() const {
        if (failed_) std::rethrow_exception(failure_);
    }

  private:
    bool stops(Clock::time_point end);
    void look(Clock::time_point now);

    const SessionOptions& options_;
    SessionResult& result_;
    std::function<void(const ProgressMonitor&)> show_;
    std::optional<ProgressMonitor> monitor_; ///< of the pass in progress
    std::thread::id thread_ = std::this_thread::get_id();
    Clock::time_point lastLook_ = Clock::now();
    std::atomic<bool> failed_{false};
    std::exception_ptr failure_; ///< if failed_
};

bool PassRunner::run(PassInfo pass, Clock::time_point end,
                     const std::function<void(const PassInfo&, Statistics&)>& render) {
    monitor_.emplace([this, end] { return stops(end); });
    pass.watch = ProgressToken(*monitor_);
    Statistics statistics;
    StageTimer timer(result_.statistics, "passes broken off");
    try {
        render(pass, statistics);
    } catch (const PassCancelled&) {
        result_.brokenOff = monitor_->progress();
        return false;
    }
    timer.discard();
    result_.statistics.add(statistics);
    return true;
}

/// Any thread of the pass.
bool PassRunner::stops(Clock::time_point end) {
    const Clock::time_point now = Clock::now();
    if (std::this_thread::get_id() == thread_) look(now);
    return failed_.load(std::memory_order_relaxed) || interrupted() || now >= end;
}

void PassRunner::look(Clock::time_point now) {
    constexpr std::chrono::milliseconds Between(50);
    if (now - lastLook_ < Between || failed_) return;
    lastLook_ = now;
    try {
        if (options_.duringPass) options_.duringPass();
    } catch (...) {
        failure_ = std::current_exception();
        failed_ = true;
        return;
    }
    show_(*monitor_);
}

/// What a session reads and writes: images, checkpoints, the state that it resumes from.
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
    void warnAboutTarget() const;
    std::vector<Problem> write(const std::string& suffix);

    const LoadedScene& loaded_;
    const OutputFiles& outputs_;
    const SessionOptions& options_;
    SessionResult& result_;
    RenderIdentity identity_;
    Clock::time_point lastCheckpoint_ = Clock::now();
};

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

/// The state of one run of passes.
class Session {
  public:
    Session(const LoadedScene& loaded, Integrator& integrator, const OutputFiles& outputs,
            const SessionOptions& options, SessionResult& result)
        : loaded_(loaded), integrator_(integrator), outputs_(outputs), options_(options), result_(result),
          files_(loaded, outputs, options, result), shared_(options.group, result),
          firstPass_(options.passes ? options.passes->first : 0), spp_(samplesOf(options)),
          sizes_(spp_, uint64_t(options.sppStep), integrator.cutsLightPaths()), limit_(options.timeoutSeconds),
          watched_(options, result, [this](const ProgressMonitor& monitor) { showPass(monitor); }),
          trace_(shared_.isRoot() ? options.trace : std::filesystem::path(), *loaded.scene, options.seed),
          reporter_(options.quiet || !shared_.isRoot()) {}

    void run(const SceneFacts& facts, const Features& features) {
        runOnAll(options_.group, [&] { begin(facts, features); });
        shared_.shareResumed();
        black_ = facts.nothingArrives;
        const bool prepared = prepare(facts);
        if (agreed_.interrupted) return; // while loading or preparing: there is nothing to write
        if (options_.passes) return prepared ? renderPartially() : void();
        if (prepared) renderPasses();
        shared_.gatherStatistics();
    }
    /// Images and state, where there are any. Throws InputError of everything that could not be written.
    void writeImages() {
        if (!options_.passes) files_.finish();
    }
    [[nodiscard]] const Trace& trace() const { return trace_; }

  private:
    /// Checks, films, and what earlier runs have left.
    void begin(const SceneFacts& facts, const Features& features) {
        const Scene& scene = *loaded_.scene;
        if (options_.passes)
            checkWritable(partialState(), outputs_.within);
        else if (shared_.isRoot())
            checkOutputs(outputs_,
                         {scene.transport.gate.frames, options_.resumeEnabled, options_.checkpointSeconds > 0.0,
                          loaded_.inputs, Trace::filesIn(options_.trace), options_.trace});
        const bool bias = (options_.bias || options_.targetError > 0.0) && integrator_.leavesBias(facts);
        // Film, that of its bias, and one more copy of its images while they are written.
        requireMemory(loaded_, bias ? 3.0 : 2.0, integrator_.memoryBytes(), options_.memoryLimit);
        if (bias) result_.bias = filmOf(scene, PassWeight::Repeats);
        result_.film = filmOf(scene);
        if (shared_.isRoot()) files_.resume();
        result_.features = features.all;
    }
    [[nodiscard]] std::filesystem::path partialState() const {
        return outputs_.partialState(options_.passes->first, options_.passes->end);
    }

    /// Every pass goes to the file as soon as it is there.
    void renderPartially() {
        const std::filesystem::path file = partialState();
        const PartialIdentity identity =
            PartialIdentity::of(loaded_, options_.seed, options_.sppStep, outputs_.exposure);
        try {
            writeAtomically(file, [&](std::ostream& out) {
                PartialStateWriter writer(out, file.string(), identity, firstPass_);
                partial_ = &writer;
                renderPasses();
                if (result_.film.passes() == 0) throw PassCancelled();
                writer.finish(statisticsJson(loaded_, options_, result_), processCpuSeconds());
            });
            result_.written = {file};
        } catch (const PassCancelled&) { // the first: no file
        }
    }

    /// False: it was broken off, in some rank, and there are no passes.
    bool prepare(const SceneFacts& facts) {
        bool whole = true;
        runOnAll(options_.group, [&] {
            const StageTimer timer(result_.statistics, stage::Prepare);
            const auto build = [&](const PassInfo& pass, Statistics& statistics) {
                if (!black_) integrator_.prepare(facts, pass.watch.part(0.0, 0.0), statistics);
            };
            whole = watched_.run({}, limit_.end(), build);
            if (!whole) return;
            SceneFacts now = facts;
            result_.features = plannedFeatures(*loaded_.scene, integrator_, now).all; // as pilots have chosen
        });
        watched_.rethrow();
        agree(whole, false);
        if (!agreed_.whole) result_.reason = StopReason::TimedOut;
        if (agreed_.interrupted) result_.reason = StopReason::Interrupted;
        return agreed_.whole;
    }

    void renderPasses() {
        const StageTimer timer(result_.statistics, stage::Passes);
        start_ = Clock::now();
        if (shared_.isRoot()) trace_.start();
        bool stop = result_.samples >= spp_;
        while (!stop) {
            if (!renderRound()) {
                stop = afterBreak();
                continue;
            }
            if (options_.afterPass) options_.afterPass(result_);
            stop = shouldStop();
            if (shared_.isRoot()) show(stop);
        }
        result_.renderSeconds = secondsSince(start_);
        shared_.gather(); // what a broken round has left
        trace_.end(result_.film, result_.bias);
        result_.trace = trace_.entries();
    }

    void show(bool last) {
        trace_.record(result_.film, result_.bias, shared_.isWhole());
        if (last || reporter_.due()) reporter_.show(state(), last);
        if (!last && shared_.isWhole()) files_.checkpointIfDue(); // else in a round that gathers it
    }

    [[nodiscard]] std::vector<PlannedPass> nextRound() const {
        const double done = result_.film.totalWeight();
        // A black image is there at once; partial states hold every pass all the same.
        if (black_ && !partial_) return {{sizes_.rest(done), result_.film.passes(), done}};
        return roundOf(sizes_, {sizes_.next(done), result_.film.passes(), done}, size_t(result_.ranks), double(spp_));
    }

    /// One pass of every rank. False: not even the first of them has ended.
    bool renderRound() {
        const std::vector<PlannedPass> round = nextRound();
        const size_t mine = shared_.rank();
        const bool whole = mine >= round.size() || renderPass(round[mine]);
        watched_.rethrow();
        agree(whole, false);
        const size_t passes = std::min(round.size(), agreed_.wholePasses);
        if (passes == 0) return false;
        if (partial_) partial_->add(result_.film, round[0].size.samples);
        shared_.collect(passes);
        for (size_t rank = 0; rank < passes && !targetReached_; ++rank) {
            shared_.fold(rank, round[rank].size.weight);
            result_.samples = uint64_t(result_.film.totalWeight());
            if (options_.targetError > 0.0 && checksError(result_.film.passes()))
                targetReached_ = shared_.errorIsBelow(options_.targetError);
        }
        endedAPass_ = true;
        return true;
    }

    /// Into the film's pass image. False: it was broken off.
    bool renderPass(const PlannedPass& planned) {
        PassInfo pass = planned.info(firstPass_, uint64_t(options_.sppStep), options_.seed);
        result_.film.beginPass();
        if (result_.estimatesBias()) {
            result_.bias.beginPass();
            if (passesOfItsBias(planned.index) > 0) pass.bias = &result_.bias;
        }
        return watched_.run(pass, mayCut() ? limit_.endOfFirstPass() : limit_.end(),
                            [this](const PassInfo& watched, Statistics& statistics) {
                                if (!black_) integrator_.renderPass(watched, result_.film, statistics);
                            });
    }

    void showPass(const ProgressMonitor& monitor) {
        if (!reporter_.due()) return;
        ProgressState progress = state();
        progress.pass = monitor.progress();
        for (const PlannedPass& pass : nextRound()) progress.samplesOfPass += pass.size.weight;
        reporter_.show(progress, false);
    }

    /// Before a pass of this run has ended; a partial state has whole passes.
    [[nodiscard]] bool mayCut() const { return !endedAPass_ && !options_.passes && sizes_.canCut(); }

    /// Whether the render ends with the pass that was broken off; else passes are smaller from now on.
    bool afterBreak() {
        if (agreed_.interrupted || agreed_.timedOut) {
            result_.reason = agreed_.interrupted ? StopReason::Interrupted : StopReason::TimedOut;
            return true;
        }
        sizes_.cut(agreed_.brokenAt);
        if (shared_.isRoot())
            std::fprintf(stderr,
                         "warning: %s: the first pass did not end within %.3g s, a quarter of the time-out: %s\n",
                         loaded_.diagnostics->file.c_str(), limit_.firstPassSeconds(), sizes_.text().c_str());
        return false;
    }

    /// Among all ranks.
    void agree(bool whole, bool wantsFilm) {
        RoundStatus own;
        own.interrupted = watched_.interrupted();
        own.timedOut = limit_.isOver();
        own.wantsFilm = wantsFilm;
        own.whole = whole;
        own.brokenAt = watched_.brokenAt();
        agreed_ = own.among(shared_, size_t(result_.ranks));
    }

    bool shouldStop() {
        const bool due = files_.checkpointDue() || trace_.due() || (!options_.quiet && shared_.mayShow());
        agree(true, shared_.isRoot() && due);
        const bool stop = stopsAfterRound();
        if (stop || agreed_.wantsFilm) shared_.gather();
        return stop;
    }

    bool stopsAfterRound() {
        const auto because = [&](StopReason reason) {
            result_.reason = reason;
            return true;
        };
        if (result_.samples >= spp_) return because(StopReason::Finished);
        if (agreed_.interrupted) return because(StopReason::Interrupted);
        if (agreed_.timedOut) return because(StopReason::TimedOut);
        return targetReached_ && because(StopReason::TargetReached);
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
        const ShownErrors errors = shared_.errors();
        progress.relativeError = errors.relative;
        progress.errorBound = errors.bound;
        progress.bias = errors.bias;
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
    mutable DistributedResult shared_;
    uint32_t firstPass_;
    uint64_t spp_; ///< of this session
    PassSizes sizes_;
    RoundStatus agreed_;      ///< of all ranks
    bool endedAPass_ = false; ///< in this run
    bool targetReached_ = false;
    TimeLimit limit_;
    PassRunner watched_;
    PartialStateWriter* partial_ = nullptr;
    bool black_ = false; ///< nothing arrives: no pass is rendered
    Trace trace_;
    ProgressReporter reporter_;
    Clock::time_point start_ = Clock::now(); ///< of passes, once they begin
};

} // namespace

void runSession(const LoadedScene& loaded, Integrator& integrator, const SceneFacts& facts, const Features& features,
                const OutputFiles& outputs, const SessionOptions& options, SessionResult& result) {
    Session session(loaded, integrator, outputs, options, result);
    session.run(facts, features);
    if (result.film.passes() == 0 || (options.group && options.group->rank() > 0)) return;
    std::vector<Problem> problems; // of one output: the others are written all the same
    const auto attempt = [&](const auto& write) {
        try {
            write();
        } catch (const InputError& error) {
            problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        }
    };
    const auto attemptFile = [&](const std::filesystem::path& file, const auto& write) {
        if (file.empty()) return;
        attempt([&] {
            makeFolderOf(file);
            write();
            result.written.push_back(file);
        });
    };
    attempt([&] { session.writeImages(); });
    attemptFile(outputs.statistics,
                [&] { writeTextFile(outputs.statistics, statisticsJson(loaded, options, result)); });
    attemptFile(outputs.page, [&] { writePage(outputs.page, pageOf(loaded, options, result)); });
    attempt([&] { session.trace().requireWritten(); });
    if (!problems.empty()) throw InputError(problems);
}

} // namespace tungsten
