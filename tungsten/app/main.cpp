// `tungsten`: scenes in, time-resolved images out.

#include "tungsten/app/Describe.h"
#include "tungsten/app/ExitCodes.h"
#include "tungsten/app/List.h"
#include "tungsten/app/Merge.h"
#include "tungsten/app/Options.h"
#include "tungsten/app/OwnOutputs.h"
#include "tungsten/app/RenderScene.h"
#include "tungsten/app/Signals.h"
#include "tungsten/app/Silence.h"
#include "tungsten/core/Errors.h"
#include "tungsten/core/SystemError.h"
#include "tungsten/session/Memory.h"
#include "tungsten/session/Report.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>
#include <optional>
#include <thread>

namespace tungsten {

namespace {

void printErrors(const InputError& error) {
    printWarnings(error.warnings());
    for (const Problem& problem : error.problems()) std::cerr << "error: " << problem.text() << '\n';
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
    if (aloud) std::cerr << "error: " << printable(message) << '\n';
    return code;
}

/// Exit code of one scene; reports what went wrong. What fails in one rank alone, while others wait for it, ends all.
int tryScene(const std::filesystem::path& file, const Options& options, const Plugins& plugins, ProcessGroup* group) {
    const auto tellAs = [&](const std::exception_ptr& failure) {
        if (!isRoot(group)) std::cerr << "rank " << group->rank() << " on " << group->machine() << ": ";
        return tell(failure, file.string());
    };
    try {
        return renderScene(file, options, plugins, group);
    } catch (const GroupFailure& failure) {
        return failure.toTell() ? tellAs(failure.toTell()) : ExitBadInput;
    } catch (...) {
        const int code = tellAs(std::current_exception());
        if (group) group->abort(code);
        return code;
    }
}

void printFields(const Options& options, const Plugins& plugins) {
    const auto selected = selectDescriptions(describeAll(plugins.registry), *options.describe);
    options.markdown ? printMarkdown(selected, std::cout) : printDescriptions(selected, std::cout);
}

/// Of a process: those that share a machine share its processors, unless the launcher has bound each to some.
size_t threadsOf(const Options& options, const ProcessGroup* group) {
    using tbb::global_control;
    if (options.threads > 0) return size_t(options.threads);
    const size_t all = global_control::active_value(global_control::max_allowed_parallelism);
    if (!group || all < std::thread::hardware_concurrency()) return all;
    return std::max<size_t>(all / size_t(group->onThisMachine()), 1);
}

/// Options of a group's rank, which has a part of the machine; what renders nothing is rank 0's.
Options shareOf(const Options& options, const ProcessGroup& group) {
    if (options.passes) throw UsageError("--passes: mpirun gives passes to its processes itself; goes without it");
    Options mine = options;
    if (mine.memoryLimit <= 0.0) mine.memoryLimit = availableMemoryBytes() / double(group.onThisMachine());
    return mine;
}

int run(const Options& options, ProcessGroup* group) {
    const bool renders = !options.describe && !options.list && !options.explain && !options.planCost;
    if (!renders && !isRoot(group)) return 0;
    if (!renders) group = nullptr;
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
    if (isRoot(group)) printWarnings(plugins.problems);
    using tbb::global_control;
    const global_control threads(global_control::max_allowed_parallelism, threadsOf(options, group));
    if (options.memoryLimit > 0.0) limitMemory(options.memoryLimit, std::thread::hardware_concurrency());
    handleSignals(group);
    if (!options.explain && !options.planCost) requireOutputsOfTheirOwn(options);
    int code = 0;
    const Options mine = group ? shareOf(options, *group) : options;
    for (const auto& scene : options.scenes) {
        const bool ends = group ? group->allReduceMax({double(interrupted)})[0] > 0.0 : bool(interrupted);
        if (ends) return ExitInterrupted; // not all were rendered
        code = std::max(code, tryScene(scene, mine, plugins, group));
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
    letTooLargeFilesFail();
    std::unique_ptr<ProcessGroup> group;
    try {
        group = joinProcessGroup();
        std::optional<Silence> silence;
        if (!isRoot(group.get())) silence.emplace(); // --help, --version and what else the parser prints
        if (argc > 1 && std::strcmp(argv[1], "merge") == 0)
            return withWholeOutput(isRoot(group.get()) ? mergeCommand(argc - 1, argv + 1) : 0);
        const auto options = parseOptions(argc, argv);
        return withWholeOutput(options ? run(*options, group.get()) : 0);
    } catch (...) { // before any rank waits for another: all meet it
        return tell(std::current_exception(), "tungsten", isRoot(group.get()));
    }
}
