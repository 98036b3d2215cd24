#include "tungsten/render/RenderSession.h"

#include "tungsten/film/AtomicFile.h"
#include "tungsten/film/ImageIo.h"
#include "tungsten/render/HtmlPage.h"
#include "tungsten/render/Memory.h"
#include "tungsten/render/Progress.h"
#include "tungsten/render/RoundAgreement.h"
#include "tungsten/render/RoundPass.h"
#include "tungsten/render/SceneFilm.h"
#include "tungsten/render/SessionFiles.h"
#include "tungsten/render/TimeLimit.h"
#include "tungsten/render/WatchedPass.h"

#include <bit>
#include <chrono>
#include <cstdio>

namespace tungsten {

namespace {

using Clock = WatchedPass::Clock;

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
        : loaded_(loaded), integrator_(integrator), outputs_(outputs), options_(options), result_(result),
          files_(loaded, outputs, options, result), shared_(options.team, result),
          firstPass_(options.passes ? options.passes->first : 0), spp_(samplesOf(options)),
          sizes_(spp_, uint64_t(options.sppStep), integrator.cutsLightPaths()), limit_(options.timeoutSeconds),
          watched_(options, result, [this](const PassMonitor& monitor) { showPass(monitor); }),
          trace_(shared_.speaks() ? options.trace : std::filesystem::path(), *loaded.scene, options.seed),
          reporter_(options.quiet || !shared_.speaks()) {}

    void run(const EffectPlan& plan) {
        together(options_.team, [&] { begin(plan); });
        shared_.shareResumed();
        black_ = plan.nothingArrives;
        const bool prepared = prepare(plan);
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
    void begin(const EffectPlan& plan) {
        const Scene& scene = *loaded_.scene;
        if (options_.passes)
            checkWritable(partialState(), outputs_.within);
        else if (shared_.speaks())
            checkOutputs(outputs_, {scene.transport.gate.frames, options_.resumeEnabled,
                                    options_.checkpointSeconds > 0.0, loaded_.inputs, options_.trace});
        const bool bias = (options_.bias || options_.targetError > 0.0) && integrator_.leavesBias(plan);
        // Film, that of its bias, and one more copy of its images while they are written.
        requireMemory(loaded_, bias ? 3.0 : 2.0, integrator_.memoryBytes(), options_.memoryLimit);
        if (bias) result_.bias = filmOf(scene, PassWeight::Repeats);
        result_.film = filmOf(scene);
        if (shared_.speaks()) files_.resume();
        result_.effects = plan.effects;
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
                if (result_.film.passes() == 0) throw PassBrokenOff();
                writer.finish(statisticsJson(loaded_, options_, result_), processCpuSeconds());
            });
            result_.written = {file};
        } catch (const PassBrokenOff&) { // the first: no file
        }
    }

    /// False: it was broken off, in some rank, and there are no passes.
    bool prepare(const EffectPlan& plan) {
        bool whole = true;
        together(options_.team, [&] {
            const StageTimer timer(result_.statistics, "prepare");
            const auto build = [&](const PassInfo& pass, Statistics& statistics) {
                if (!black_) integrator_.prepare(plan, pass.watch.part(0.0, 0.0), statistics);
            };
            whole = watched_.run({}, limit_.end(), build);
        });
        watched_.rethrow();
        agree(whole, false);
        if (!agreed_.whole) result_.reason = StopReason::TimedOut;
        if (agreed_.interrupted) result_.reason = StopReason::Interrupted;
        return agreed_.whole;
    }

    void renderPasses() {
        const StageTimer timer(result_.statistics, "passes");
        start_ = Clock::now();
        if (shared_.speaks()) trace_.start();
        bool stop = result_.samples >= spp_;
        while (!stop) {
            if (!renderRound()) {
                stop = afterBreak();
                continue;
            }
            if (options_.afterPass) options_.afterPass(result_);
            stop = shouldStop();
            if (shared_.speaks()) show(stop);
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

    [[nodiscard]] std::vector<RoundPass> nextRound() const {
        const double done = result_.film.totalWeight();
        // A black image is there at once; partial states hold every pass all the same.
        if (black_ && !partial_) return {{sizes_.rest(done), result_.film.passes(), done}};
        return roundOf(sizes_, {sizes_.next(done), result_.film.passes(), done}, size_t(result_.ranks), double(spp_));
    }

    /// One pass of every rank. False: not even the first of them has ended.
    bool renderRound() {
        const std::vector<RoundPass> round = nextRound();
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
    bool renderPass(const RoundPass& planned) {
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

    void showPass(const PassMonitor& monitor) {
        if (!reporter_.due()) return;
        ProgressState progress = state();
        progress.pass = monitor.progress();
        for (const RoundPass& pass : nextRound()) progress.samplesOfPass += pass.size.weight;
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
        if (shared_.speaks())
            std::fprintf(stderr,
                         "warning: %s: the first pass did not end within %.3g s, a quarter of the time-out: %s\n",
                         loaded_.diagnostics->file.c_str(), limit_.firstPassSeconds(), sizes_.text().c_str());
        return false;
    }

    /// Among all ranks.
    void agree(bool whole, bool wantsFilm) {
        RoundAgreement own;
        own.interrupted = watched_.interrupted();
        own.timedOut = limit_.isOver();
        own.wantsFilm = wantsFilm;
        own.whole = whole;
        own.brokenAt = watched_.brokenAt();
        agreed_ = own.among(shared_, size_t(result_.ranks));
    }

    bool shouldStop() {
        const bool due = files_.checkpointDue() || trace_.due() || (!options_.quiet && shared_.mayShow());
        agree(true, shared_.speaks() && due);
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
    mutable SharedResult shared_;
    uint32_t firstPass_;
    uint64_t spp_; ///< of this session
    PassSizes sizes_;
    RoundAgreement agreed_;   ///< of all ranks
    bool endedAPass_ = false; ///< in this run
    bool targetReached_ = false;
    TimeLimit limit_;
    WatchedPass watched_;
    PartialStateWriter* partial_ = nullptr;
    bool black_ = false; ///< nothing arrives: no pass is rendered
    Trace trace_;
    ProgressReporter reporter_;
    Clock::time_point start_; ///< of passes
};

} // namespace

void runSession(const LoadedScene& loaded, Integrator& integrator, const EffectPlan& plan, const OutputFiles& outputs,
                const SessionOptions& options, SessionResult& result) {
    Session session(loaded, integrator, outputs, options, result);
    session.run(plan);
    if (result.film.passes() == 0 || (options.team && options.team->rank() > 0)) return;
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
    attemptFile(outputs.page, [&] { writeFilmPage(outputs.page, loaded, options, result); });
    attempt([&] { session.trace().requireWritten(); });
    if (!problems.empty()) throw InputError(problems);
}

} // namespace tungsten
