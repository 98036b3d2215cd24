// `tungsten`: scenes in, time-resolved images out.

#include "tungsten/app/Describe.h"
#include "tungsten/app/List.h"
#include "tungsten/app/Options.h"
#include "tungsten/app/PlanCost.h"
#include "tungsten/core/Errors.h"
#include "tungsten/render/Describe.h"
#include "tungsten/render/Memory.h"
#include "tungsten/render/Plugin.h"
#include "tungsten/render/Progress.h"
#include "tungsten/render/RenderSession.h"

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

std::atomic<bool> interrupted{false};

/// First signal: finish the pass and write. Second: leave at once.
void onInterrupt(int) {
    if (interrupted.exchange(true)) _exit(ExitInterrupted);
}

/// Integrators, what went wrong while loading them, and where they were looked for.
struct Plugins {
    IntegratorRegistry registry;
    std::vector<std::filesystem::path> directories = pluginDirectories();
    std::vector<Problem> problems = loadPlugins(directories, registry);
};

void printWarnings(const std::vector<Problem>& warnings, size_t more = 0) {
    for (const Problem& warning : warnings) std::cerr << "warning: " << warning.text() << '\n';
    if (more > 0) std::cerr << "warning: and " << more << " more\n";
}

[[noreturn]] void failUnknownIntegrator(const LoadedScene& loaded, const Plugins& plugins) {
    std::vector<std::string> types;
    for (const auto& [type, entry] : plugins.registry.entries()) types.push_back(type);
    std::string message = types.empty() ? "no integrator is known" : "expected " + listOf(types);
    message += ", found '" + loaded.integratorType + "'";
    const std::string near = nearestName(loaded.integratorType, types);
    if (!near.empty()) message += "; did you mean '" + near + "'?";
    message += " (plugins were looked for in";
    for (size_t i = 0; i < plugins.directories.size(); ++i)
        message += (i > 0 ? ", " : " ") + plugins.directories[i].string();
    throw InputError({{loaded.diagnostics->file, "integrator.type", message + ")"}});
}

std::unique_ptr<Integrator> makeIntegrator(const LoadedScene& loaded, const Plugins& plugins) {
    const auto found = plugins.registry.entries().find(loaded.integratorType);
    if (found == plugins.registry.entries().end()) failUnknownIntegrator(loaded, plugins);
    auto integrator = found->second.factory(loaded.scene, loaded.integratorSettings);
    throwIfProblems(*loaded.diagnostics);
    loaded.integratorSettings.warnAboutUnknown();
    return integrator;
}

SessionOptions sessionOptions(const Options& options, const RendererSettings& renderer) {
    SessionOptions session;
    session.seed = options.seed;
    session.spp = options.spp.value_or(renderer.spp);
    session.sppStep = renderer.sppStep;
    session.timeoutSeconds = options.timeoutSeconds.value_or(renderer.timeoutSeconds);
    session.checkpointSeconds = options.checkpointSeconds.value_or(renderer.checkpointSeconds);
    session.resumeEnabled = renderer.enableResume || options.checkpointSeconds.has_value();
    session.restart = options.restart;
    session.targetError = options.targetError;
    session.bias = options.bias;
    session.memoryLimit = options.memoryLimit;
    session.quiet = options.quiet;
    session.trace = options.trace;
    session.command = options.command;
    session.interrupted = &interrupted;
    return session;
}

void printSummary(const SessionResult& result) {
    if (result.film.passes() == 0) {
        std::printf("interrupted before the first pass: nothing was written\n");
        return;
    }
    std::printf("%u passes, %llu samples per pixel in %.1f s (%s)", result.film.passes(),
                static_cast<unsigned long long>(result.samples), result.renderSeconds, toString(result.reason).c_str());
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

/// Exit code: 0, or 130 when interrupted before there was anything to write.
int renderScene(const std::filesystem::path& file, const Options& options, const Plugins& plugins) {
    if (options.planCost) {
        planCost(file, options, [&](const LoadedScene& loaded) { return makeIntegrator(loaded, plugins); });
        return 0;
    }
    SessionResult result;
    std::optional<StageTimer> loading(std::in_place, result.statistics, "load");
    const LoadedScene loaded =
        loadScene(file, {options.inputDirectory, options.overrides, options.outputs.allowOutside});
    const auto integrator = makeIntegrator(loaded, plugins);
    printWarnings(loaded.diagnostics->warnings, loaded.diagnostics->moreWarnings);
    EffectPlan plan = analyseScene(*loaded.scene);
    integrator->plan(plan);
    loading.reset();
    if (options.explain) {
        std::cout << file.string() << " (" << loaded.integratorType << ")\n";
        printPlan(plan, std::cout);
        return 0;
    }
    const OutputFiles outputs = resolveOutputs(loaded.renderer, file, options.outputs);
    runSession(loaded, *integrator, plan, outputs, sessionOptions(options, loaded.renderer), result);
    if (!options.quiet) printSummary(result);
    return result.film.passes() == 0 ? ExitInterrupted : 0;
}

/// Exit code of one scene; reports what went wrong.
int tryScene(const std::filesystem::path& file, const Options& options, const Plugins& plugins) {
    try {
        return renderScene(file, options, plugins);
    } catch (const InputError& error) {
        for (const Problem& problem : error.problems()) std::cerr << "error: " << problem.text() << '\n';
    } catch (const UsageError& error) {
        std::cerr << "error: " << error.what() << '\n';
        return ExitBadUsage;
    } catch (const std::bad_alloc&) {
        std::cerr << "error: " << file.string()
                  << ": out of memory; try a smaller --resolution, fewer frames or fewer photons\n";
    } catch (const std::exception& error) {
        std::cerr << "error: " << file.string() << ": " << error.what() << '\n';
    }
    return ExitBadInput;
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
        if (renderer.enableResume || options.checkpointSeconds) written.push_back(files.state);
        written.push_back(files.statistics);
        for (const auto& file : written) {
            if (file.empty()) continue;
            const auto [writer, added] = writers.emplace(std::filesystem::weakly_canonical(file), i);
            if (!added && writer->second != i)
                throw UsageError(scene.string() + " would write " + file.string() + ", as " +
                                 options.scenes[writer->second].string() +
                                 " does; render them one by one, with folders (-d) or names of their own");
        }
    }
}

/// Signals that ask for an end are handled, but those that whoever started the command has set aside (nohup). A reader
/// of our messages that goes away is no reason to lose a render.
void handleSignals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(signal, onInterrupt) == SIG_IGN) std::signal(signal, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

void printFields(const Options& options, const Plugins& plugins) {
    const auto selected = selectDescriptions(describeAll(plugins.registry), *options.describe);
    options.markdown ? printMarkdown(selected, std::cout) : printDescriptions(selected, std::cout);
}

int run(const Options& options) {
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
    printWarnings(plugins.problems);
    using tbb::global_control;
    const size_t all = global_control::active_value(global_control::max_allowed_parallelism);
    const global_control threads(global_control::max_allowed_parallelism,
                                 options.threads > 0 ? size_t(options.threads) : all);
    if (options.memoryLimit > 0.0) limitMemory(options.memoryLimit, std::thread::hardware_concurrency());
    handleSignals();
    if (!options.explain && !options.planCost) requireOutputsOfTheirOwn(options);
    int code = 0;
    for (const auto& scene : options.scenes) {
        if (interrupted) return ExitInterrupted; // not all were rendered
        code = std::max(code, tryScene(scene, options, plugins));
    }
    return code;
}

/// The exit code, or 1 if what was printed got lost on a full disk.
int withWholeOutput(int code) {
    std::cout.flush();
    const bool lost = std::fflush(stdout) != 0 || !std::cout || std::ferror(stdout);
    if (!lost || errno == EPIPE) return code;
    std::cerr << "error: standard output: cannot be written: " << std::strerror(errno) << '\n';
    return std::max(code, ExitBadInput);
}

} // namespace

} // namespace tungsten

int main(int argc, char** argv) {
    using namespace tungsten;
    try {
        const auto options = parseOptions(argc, argv);
        return withWholeOutput(options ? run(*options) : 0);
    } catch (const UsageError& error) {
        std::cerr << "error: " << error.what() << '\n';
        return ExitBadUsage;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return ExitBadInput;
    }
}
