// `tungsten`: scenes in, time-resolved images out.

#include "tungsten/app/Describe.h"
#include "tungsten/app/List.h"
#include "tungsten/app/Merge.h"
#include "tungsten/app/Options.h"
#include "tungsten/app/PlanCost.h"
#include "tungsten/app/Silence.h"
#include "tungsten/core/Errors.h"
#include "tungsten/core/SystemError.h"
#include "tungsten/render/Describe.h"
#include "tungsten/render/Job.h"
#include "tungsten/render/Memory.h"
#include "tungsten/render/PlanReport.h"
#include "tungsten/render/Progress.h"
#include "tungsten/render/RenderSession.h"
#include "tungsten/render/Team.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <map>
#include <new>
#include <optional>
#include <thread>

#include <unistd.h>

namespace tungsten {

namespace {

constexpr int ExitBadInput = 1, ExitBadUsage = 2, ExitInterrupted = 130;

std::atomic<bool> interrupted{false}, atLoading{false};

/// First signal: break the pass off and write what those before it gave. Second, or while a scene is loaded: leave at
/// once.
void onInterrupt(int) {
    constexpr char Message[] = "interrupted while loading: nothing was written\n";
    if (atLoading && write(STDERR_FILENO, Message, sizeof Message - 1) >= 0) _exit(ExitInterrupted);
    if (interrupted.exchange(true)) _exit(ExitInterrupted);
}

bool speaks(const Team* team) {
    return !team || team->rank() == 0;
}

void printWarnings(const std::vector<Problem>& warnings, size_t more = 0) {
    for (const Problem& warning : warnings) std::cerr << "warning: " << warning.text() << '\n';
    if (more > 0) std::cerr << "warning: and " << more << " more\n";
}

void printErrors(const InputError& error) {
    for (const Problem& problem : error.problems()) std::cerr << "error: " << problem.text() << '\n';
}

SessionOptions sessionOptions(const Options& options, const RendererSettings& renderer, Team* team) {
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
    session.team = team;
    session.trace = options.trace;
    session.command = options.command;
    session.interrupted = &interrupted;
    return session;
}

void printSummary(const SessionResult& result) {
    if (result.film.passes() == 0) {
        std::printf("interrupted before the first pass had ended: nothing was written\n");
        return;
    }
    std::printf("%u passes, %.10g samples per pixel in %.1f s (%s)", result.film.passes(), result.film.totalWeight(),
                result.renderSeconds, toString(result.reason).c_str());
    const double error = result.film.relativeStandardError();
    if (!std::isnan(error))
        std::printf(", %s", errorText(error, result.film.relativeErrorBound(), result.relativeBias()).c_str());
    std::printf("\n");
    constexpr size_t MostListed = 12;
    for (size_t i = 0; i < std::min(result.written.size(), MostListed); ++i)
        std::printf("wrote %s\n", result.written[i].c_str());
    if (result.written.size() > MostListed) std::printf("and %zu more files\n", result.written.size() - MostListed);
    std::fflush(stdout);
}

/// Job and outputs of a scene that is rendered; only rank 0 warns.
Job loadJob(const std::filesystem::path& file, const Options& options, const Plugins& plugins, Team* team) {
    std::optional<Job> job;
    atLoading = true;
    together(team, [&] {
        job = makeJob(file, {options.inputDirectory, options.overrides, options.outputs.allowOutside, {}}, plugins,
                      options.everything);
    });
    atLoading = false;
    const Diagnostics& diagnostics = *job->loaded.diagnostics;
    if (speaks(team)) printWarnings(diagnostics.warnings, diagnostics.moreWarnings);
    return std::move(*job);
}

/// Exit code: 0, or 130 when interrupted before there was anything to write.
int renderScene(const std::filesystem::path& file, const Options& options, const Plugins& plugins, Team* team) {
    if (options.planCost) return planCost(file, options, plugins, interrupted) ? 0 : ExitInterrupted;
    SessionResult result;
    std::optional<StageTimer> loading(std::in_place, result.statistics, "load");
    const Job job = loadJob(file, options, plugins, team);
    const LoadedScene& loaded = job.loaded;
    loading.reset();
    if (options.explainAsJson) {
        std::cout << planJson(job, defaultsTaken(job, plugins.registry)) << '\n';
        return 0;
    }
    if (options.explain) {
        std::cout << file.string() << " (" << loaded.integratorType << ")\n";
        printPlan(job.plan, std::cout);
        printDefaults(defaultsTaken(job, plugins.registry), std::cout);
        return 0;
    }
    OutputFiles outputs;
    together(team, [&] { outputs = resolveOutputs(loaded.renderer, file, options.outputs); });
    const SessionOptions session = sessionOptions(options, loaded.renderer, team);
    runSession(loaded, *job.integrator, job.plan, outputs, session, result);
    if (result.film.passes() == 0 && result.reason == StopReason::TimedOut)
        together(team, [&] { throw InputError(file.string(), "time-out: " + whyNoPass(session, result)); });
    if (!options.quiet && speaks(team)) printSummary(result);
    return result.film.passes() == 0 ? ExitInterrupted : 0;
}

/// The exit code of what went wrong, which is told unless another rank does.
int tell(const std::exception_ptr& failure, const std::string& file, bool aloud = true) {
    std::string message;
    int code = ExitBadInput;
    try {
        std::rethrow_exception(failure);
    } catch (const InputError& error) {
        if (aloud) printErrors(error);
        return code;
    } catch (const UsageError& error) {
        message = error.what();
        code = ExitBadUsage;
    } catch (const std::bad_alloc&) {
        message = file + ": out of memory; try a smaller --resolution, fewer frames or fewer photons";
    } catch (const std::exception& error) {
        message = file + ": " + error.what();
    }
    if (aloud) std::cerr << "error: " << message << '\n';
    return code;
}

/// Exit code of one scene; reports what went wrong. What fails in one rank alone, while others wait for it, ends all.
int tryScene(const std::filesystem::path& file, const Options& options, const Plugins& plugins, Team* team) {
    const auto tellAs = [&](const std::exception_ptr& failure) {
        if (!speaks(team)) std::cerr << "rank " << team->rank() << " on " << team->machine() << ": ";
        return tell(failure, file.string());
    };
    try {
        return renderScene(file, options, plugins, team);
    } catch (const TeamFailure& failure) {
        return failure.toTell() ? tellAs(failure.toTell()) : ExitBadInput;
    } catch (...) {
        const int code = tellAs(std::current_exception());
        if (team) team->abort(code);
        return code;
    }
}

/// Throws UsageError if two scenes would write the same file: the later would replace the earlier's, or resume it.
void requireOutputsOfTheirOwn(const Options& options) {
    std::map<std::filesystem::path, size_t> writers;
    for (size_t i = 0; i < options.scenes.size(); ++i) {
        const std::filesystem::path& scene = options.scenes[i];
        const RendererSettings renderer = peekRenderer(scene, options.overrides);
        OutputOverrides anywhere = options.outputs;
        anywhere.allowOutside = true; // looked at when the scene is rendered
        const OutputFiles files = resolveOutputs(renderer, scene, anywhere);
        std::vector<std::filesystem::path> written;
        if (renderer.overwriteOutputFiles || options.outputs.ldr) written.push_back(files.ldr);
        if (renderer.overwriteOutputFiles || options.outputs.hdr) written.push_back(files.hdr);
        if (options.passes) written.push_back(files.partialState(options.passes->first, options.passes->end));
        if (renderer.enableResume || options.checkpointSeconds) written.push_back(files.state);
        written.push_back(files.statistics);
        for (const auto& file : written) {
            if (file.empty()) continue;
            std::error_code ignored; // what names cannot be is said before the scene is rendered
            const auto folder =
                std::filesystem::weakly_canonical(std::filesystem::absolute(file).parent_path(), ignored);
            const auto [writer, added] = writers.emplace(folder / file.filename(), i);
            if (!added && writer->second != i)
                throw UsageError(scene.string() + " would write " + file.string() + ", as " +
                                 options.scenes[writer->second].string() +
                                 " does; render them one by one, with folders (-d) or names of their own");
        }
    }
}

/// Signals that ask for an end are handled, but those that whoever started the command has set aside (nohup). A reader
/// of our messages that goes away is no reason to lose a render. SIGUSR1 is what mpirun hands on without killing.
void handleSignals(const Team* team) {
    if (team) std::signal(SIGUSR1, onInterrupt);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(signal, onInterrupt) == SIG_IGN) std::signal(signal, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

void printFields(const Options& options, const Plugins& plugins) {
    const auto selected = selectDescriptions(describeAll(plugins.registry), *options.describe);
    options.markdown ? printMarkdown(selected, std::cout) : printDescriptions(selected, std::cout);
}

/// Of a process: those that share a machine share its processors, unless the launcher has bound each to some.
size_t threadsOf(const Options& options, const Team* team) {
    using tbb::global_control;
    if (options.threads > 0) return size_t(options.threads);
    const size_t all = global_control::active_value(global_control::max_allowed_parallelism);
    if (!team || all < std::thread::hardware_concurrency()) return all;
    return std::max<size_t>(all / size_t(team->onThisMachine()), 1);
}

/// Options of a team's rank, which has a part of the machine; what renders nothing is rank 0's.
Options shareOf(const Options& options, const Team& team) {
    if (options.passes) throw UsageError("--passes: mpirun gives passes to its processes itself; goes without it");
    Options mine = options;
    if (mine.memoryLimit <= 0.0) mine.memoryLimit = availableMemoryBytes() / double(team.onThisMachine());
    return mine;
}

int run(const Options& options, Team* team) {
    const bool renders = !options.describe && !options.list && !options.explain && !options.planCost;
    if (!renders && !speaks(team)) return 0;
    if (!renders) team = nullptr;
    const Plugins plugins;
    if (options.describe) {
        printFields(options, plugins);
        printWarnings(plugins.problems);
        return 0;
    }
    if (options.list) {
        printTypes(plugins.registry, std::cout);
        printWarnings(plugins.problems);
        return 0;
    }
    if (speaks(team)) printWarnings(plugins.problems);
    using tbb::global_control;
    const global_control threads(global_control::max_allowed_parallelism, threadsOf(options, team));
    if (options.memoryLimit > 0.0) limitMemory(options.memoryLimit, std::thread::hardware_concurrency());
    handleSignals(team);
    if (!options.explain && !options.planCost) requireOutputsOfTheirOwn(options);
    int code = 0;
    const Options mine = team ? shareOf(options, *team) : options;
    for (const auto& scene : options.scenes) {
        const bool ends = team ? team->largest({double(interrupted)})[0] > 0.0 : bool(interrupted);
        if (ends) return ExitInterrupted; // not all were rendered
        code = std::max(code, tryScene(scene, mine, plugins, team));
    }
    return code;
}

/// The exit code, or 1 if what was printed got lost on a full disk.
int withWholeOutput(int code) {
    std::cout.flush();
    const bool lost = std::fflush(stdout) != 0 || !std::cout || std::ferror(stdout);
    if (!lost || errno == EPIPE) return code;
    std::cerr << "error: standard output: cannot be written: " << systemError(errno) << '\n';
    return std::max(code, ExitBadInput);
}

} // namespace

} // namespace tungsten

int main(int argc, char** argv) {
    using namespace tungsten;
    keepFreedMemory();
    std::unique_ptr<Team> team;
    try {
        team = joinTeam();
        std::optional<Silence> silence;
        if (!speaks(team.get())) silence.emplace(); // --help, --version and what else the parser prints
        if (argc > 1 && std::strcmp(argv[1], "merge") == 0)
            return withWholeOutput(speaks(team.get()) ? mergeCommand(argc - 1, argv + 1) : 0);
        const auto options = parseOptions(argc, argv);
        return withWholeOutput(options ? run(*options, team.get()) : 0);
    } catch (...) { // before any rank waits for another: all meet it
        return tell(std::current_exception(), "tungsten", speaks(team.get()));
    }
}
