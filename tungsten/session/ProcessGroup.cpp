#include "tungsten/session/ProcessGroup.h"

#include "tungsten/core/Errors.h"
#include "tungsten/session/Job.h"

#include <charconv>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>

namespace tungsten {

namespace {

constexpr const char* ModuleFile = "tungsten-mpi.so";

/// 0 where it is no number.
int numberIn(std::string_view text) {
    int number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    return read.ec == std::errc() ? number : 0;
}

/// As launchers tell the processes that they start: Open MPI's mpirun, PMI (MPICH, Slurm), and Slurm with PMIx.
int processesStarted() {
    for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
        if (const char* size = std::getenv(variable)) return numberIn(size);
    const char* size = std::getenv("PMIX_RANK") ? std::getenv("SLURM_STEP_NUM_TASKS") : nullptr;
    return size ? numberIn(size) : 1;
}

std::filesystem::path moduleFile(int processes) {
    for (const auto& directory : pluginDirectories()) {
        std::error_code error;
        if (std::filesystem::exists(directory / ModuleFile, error)) return directory / ModuleFile;
    }
    throw UsageError("started as one of " + std::to_string(processes) + " processes, by mpirun for example, but " +
                     ModuleFile +
                     " is not beside the plugins: this build has no MPI (apt-get install libopenmpi-dev "
                     "openmpi-bin, then configure and build again)");
}

} // namespace

std::unique_ptr<ProcessGroup> joinProcessGroup() {
    const int processes = processesStarted();
    if (processes <= 1) return nullptr;
    const std::filesystem::path file = moduleFile(processes);
    // Never closed. Its symbols are for all, as what Open MPI loads may look for them.
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (!library) throw InputError(file.string(), std::string("cannot be loaded: ") + dlerror());
    using EntryPoint = const ProcessGroupModule* (*)();
    const auto entry = reinterpret_cast<EntryPoint>(dlsym(library, "tungstenProcessGroup"));
    if (!entry || std::strcmp(entry()->abi, PluginAbi) != 0)
        throw InputError(file.string(), "built for another version of this program");
    std::unique_ptr<ProcessGroup> group = entry()->join();
    if (group->size() == processes) return group;
    throw UsageError("started as one of " + std::to_string(processes) + " processes, but " + file.string() + " sees " +
                     std::to_string(group->size()) + ": the launcher is of another MPI than it was built with");
}

} // namespace tungsten
