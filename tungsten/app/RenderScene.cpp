#include "tungsten/app/RenderScene.h"

#include "tungsten/app/ExitCodes.h"
#include "tungsten/app/PlanCost.h"
#include "tungsten/app/Signals.h"
#include "tungsten/core/Errors.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/reader/Field.h"
#include "tungsten/session/Progress.h"
#include "tungsten/session/Report.h"
#include "tungsten/session/Session.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <optional>

namespace tungsten {

namespace {

SessionOptions sessionOptions(const Options& options, const RendererSettings& renderer, ProcessGroup* group) {
    SessionOptions session;
    session.seed = options.seed;
    session.spp = options.spp.value_or(renderer.spp);
    session.sppStep = renderer.sppStep;
    session.passes = options.passes;
    session.timeoutSeconds = options.timeoutSeconds.value_or(renderer.timeoutSeconds);
    session.checkpointSeconds = options.checkpointSeconds.value_or(renderer.checkpointSeconds);
    session.resumeEnabled = !options.passes && (renderer.enableResume || options.checkpointSeconds);
    session.restart = options.restart;
    session.targetError = options.targetError;
    session.bias = options.bias;
    session.memoryLimit = options.memoryLimit;
    session.quiet = options.quiet;
    session.group = group;
    session.trace = options.outputs.placed(options.trace);
    session.command = options.command;
    session.interrupted = &interrupted;
    return session;
}

/// Job and outputs of a scene that is rendered; only rank 0 warns.
Job loadJob(const std::filesystem::path& file, const Options& options, const Plugins& plugins, ProcessGroup* group) {
    std::optional<Job> job;
    {
        const Loading loading;
        runOnAll(group, [&] {
            job = makeJob(file, {options.inputDirectory, options.overrides, options.outputs.allowOutside, {}}, plugins,
                          options.everything);
        });
    }
    const Diagnostics& diagnostics = *job->loaded.diagnostics;
    if (isRoot(group)) printWarnings(diagnostics.warnings, diagnostics.moreWarnings);
    return std::move(*job);
}

/// Prepares a render, with the choices of its pilots, if all of it takes no longer than a second.
bool prepareQuickly(const Job& job, Statistics& statistics) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::seconds(1);
    ProgressMonitor monitor([&] { return interrupted || Clock::now() > end; });
    try {
        job.integrator->prepare(job.facts, ProgressToken(monitor), statistics);
    } catch (const PassCancelled&) {
        return false;
    }
    return true;
}

/// Of plain paths, as pilots choose them here and in a render.
void printShares(const Statistics& prepared) {
    if (prepared.counter(counter::PilotPaths) == 0) return;
    for (const std::string paths : {"camera paths", "light paths"}) {
        const auto counters = prepared.counters();
        const auto plain = counters.find("plain " + paths + ", in thousandths");
        if (plain == counters.end()) continue;
        std::cout << "  pilot     " << brief(0.001 * double(plain->second)) << " of the " << paths << " are plain\n";
    }
}

/// What a scene calls for, and what it leaves to defaults; renders nothing.
void explain(const std::filesystem::path& file, const Job& job, const std::vector<DefaultTaken>& defaults,
             Explanation how) {
    if (how == Explanation::Json) {
        std::cout << planJson(job, defaults) << '\n';
        return;
    }
    std::cout << file.string() << " (" << job.loaded.integratorType << ")\n";
    if (how == Explanation::Effects) {
        printFeatures(job.features, std::cout);
    } else {
        Statistics statistics;
        const bool prepared = prepareQuickly(job, statistics);
        SceneFacts facts = job.facts;
        const Scene& scene = *job.loaded.scene;
        printPlan(facts, prepared ? plannedFeatures(scene, *job.integrator, facts) : job.features, std::cout);
        if (prepared) printShares(statistics);
    }
    printDefaults(defaults, std::cout);
}

void printSummary(const SessionResult& result) {
    if (result.film.passes() == 0) {
        std::printf("interrupted before the first pass had ended: nothing was written\n");
        return;
    }
    std::printf("%u passes, %.10g samples per pixel in %.1f s (%s)", result.film.passes(), result.film.totalWeight(),
                result.renderSeconds, toString(result.reason).c_str());
    const double error = relativeStandardError(result.film);
    if (!std::isnan(error))
        std::printf(", %s", errorText(error, relativeErrorBound(result.film), result.relativeBias()).c_str());
    std::printf("\n");
    constexpr size_t MostListed = 12;
    for (size_t i = 0; i < std::min(result.written.size(), MostListed); ++i)
        std::printf("wrote %s\n", result.written[i].c_str());
    if (result.written.size() > MostListed) std::printf("and %zu more files\n", result.written.size() - MostListed);
    std::fflush(stdout);
}

} // namespace

void printWarnings(const std::vector<Problem>& warnings, size_t more) {
    for (const Problem& warning : warnings) std::cerr << "warning: " << warning.text() << '\n';
    if (more > 0) std::cerr << "warning: and " << more << " more\n";
}

int renderScene(const std::filesystem::path& file, const Options& options, const Plugins& plugins,
                ProcessGroup* group) {
    if (options.planCost) return planCost(file, options, plugins, interrupted) ? 0 : ExitInterrupted;
    SessionResult result;
    std::optional<StageTimer> loading(std::in_place, result.statistics, "load");
    const Job job = loadJob(file, options, plugins, group);
    const LoadedScene& loaded = job.loaded;
    loading.reset();
    if (options.explain) {
        explain(file, job, defaultsTaken(job, plugins.registry), *options.explain);
        return 0;
    }
    OutputFiles outputs;
    runOnAll(group, [&] { outputs = resolveOutputs(loaded.renderer, file, options.outputs); });
    const SessionOptions session = sessionOptions(options, loaded.renderer, group);
    runSession(loaded, *job.integrator, job.facts, job.features, outputs, session, result);
    if (result.film.passes() == 0 && result.reason == StopReason::TimedOut)
        runOnAll(group, [&] { throw InputError(file.string(), "time-out: " + whyNoPass(session, result)); });
    const auto black =
        isRoot(group) && !options.passes ? blackImage(*loaded.scene, job.facts, job.features, result) : std::nullopt;
    if (black) printWarnings({*black});
    if (!options.quiet && isRoot(group)) printSummary(result);
    return result.film.passes() == 0 ? ExitInterrupted : 0;
}

} // namespace tungsten
