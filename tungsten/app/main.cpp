// `tungsten`: scenes in, time-resolved images out.

#include "tungsten/app/List.h"
#include "tungsten/app/Options.h"
#include "tungsten/core/Errors.h"
#include "tungsten/render/Plugin.h"
#include "tungsten/render/RenderSession.h"

#include <tbb/global_control.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>

#include <unistd.h>

namespace tungsten {

namespace {

constexpr int ExitBadInput = 1, ExitBadUsage = 2, ExitInterrupted = 130;

std::atomic<bool> interrupted{false};

/// First signal: finish the pass and write. Second: leave at once.
void onInterrupt(int) {
    if (interrupted.exchange(true)) _exit(ExitInterrupted);
}

void printWarnings(const Diagnostics& diagnostics) {
    for (const Problem& warning : diagnostics.warnings) std::cerr << "warning: " << warning.text() << '\n';
}

std::unique_ptr<Integrator> makeIntegrator(const LoadedScene& loaded, const IntegratorRegistry& registry,
                                           const std::vector<Problem>& pluginProblems) {
    const auto found = registry.entries().find(loaded.integratorType);
    if (found == registry.entries().end()) {
        std::vector<std::string> types;
        for (const auto& [type, entry] : registry.entries()) types.push_back(type);
        const std::string near = nearestName(loaded.integratorType, types);
        std::vector<Problem> problems = pluginProblems;
        problems.push_back({loaded.diagnostics->file, "integrator.type",
                            "expected " + (types.empty() ? "a type from a plugin, but no plugin was found" : listOf(types)) + ", found '" +
                                loaded.integratorType + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?")});
        throw InputError(problems);
    }
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
    session.quiet = options.quiet;
    session.interrupted = &interrupted;
    return session;
}

void printSummary(const SessionResult& result) {
    std::printf("%u passes, %llu samples per pixel in %.1f s (%s), standard error %.3g %%\n", result.film.passes(),
                static_cast<unsigned long long>(result.samples), result.renderSeconds, toString(result.reason).c_str(),
                100.0 * result.film.relativeStandardError());
    constexpr size_t MostListed = 12;
    for (size_t i = 0; i < std::min(result.written.size(), MostListed); ++i)
        std::printf("wrote %s\n", result.written[i].c_str());
    if (result.written.size() > MostListed) std::printf("and %zu more files\n", result.written.size() - MostListed);
}

void renderScene(const std::filesystem::path& file, const Options& options, const IntegratorRegistry& registry,
                 const std::vector<Problem>& pluginProblems) {
    const LoadedScene loaded = loadScene(file, {options.inputDirectory, options.overrides});
    const auto integrator = makeIntegrator(loaded, registry, pluginProblems);
    printWarnings(*loaded.diagnostics);
    EffectPlan plan = analyseScene(*loaded.scene);
    integrator->plan(plan);
    if (options.explain) {
        std::cout << file.string() << " (" << loaded.integratorType << ")\n";
        printPlan(plan, std::cout);
        return;
    }
    const OutputFiles outputs = resolveOutputs(loaded.renderer, file, options.outputs);
    SessionResult result;
    runSession(loaded, *integrator, plan, outputs, sessionOptions(options, loaded.renderer), result);
    if (!options.quiet) printSummary(result);
}

int run(const Options& options) {
    IntegratorRegistry registry;
    const std::vector<Problem> pluginProblems = loadPlugins(pluginDirectories(), registry);
    if (options.list) {
        printTypes(registry, std::cout);
        for (const Problem& problem : pluginProblems) std::cerr << "warning: " << problem.text() << '\n';
        return 0;
    }
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      options.threads > 0 ? size_t(options.threads)
                                                          : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
    int code = 0;
    for (const auto& scene : options.scenes) {
        if (interrupted) break;
        try {
            renderScene(scene, options, registry, pluginProblems);
        } catch (const InputError& error) {
            for (const Problem& problem : error.problems()) std::cerr << "error: " << problem.text() << '\n';
            code = ExitBadInput;
        }
    }
    return code;
}

} // namespace

} // namespace tungsten

int main(int argc, char** argv) {
    using namespace tungsten;
    try {
        const auto options = parseOptions(argc, argv);
        return options ? run(*options) : 0;
    } catch (const UsageError& error) {
        std::cerr << "error: " << error.what() << '\n';
        return ExitBadUsage;
    } catch (const std::bad_alloc&) {
        std::cerr << "error: out of memory; try a smaller --resolution or fewer photons\n";
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
    }
    return ExitBadInput;
}
