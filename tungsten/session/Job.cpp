#include "tungsten/session/Job.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/FileBytes.h"
#include "tungsten/integrator/Plugin.h"
#include "tungsten/reader/FormatTypes.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>

#include <dlfcn.h>
#include <link.h>

namespace tungsten {

namespace {

/// Null if there is none of the type, which is a problem.
const IntegratorRegistry::Entry* integratorOf(const ObjectReader& block, const std::string& type,
                                              const Plugins& plugins) {
    const auto found = plugins.registry.entries().find(type);
    if (found != plugins.registry.entries().end()) return &found->second;
    std::vector<std::string> types;
    for (const auto& [known, entry] : plugins.registry.entries()) types.push_back(known);
    std::string message =
        refusal(type, "'" + type + "'", types, unsupportedIntegrators()) + " (plugins were looked for in";
    for (size_t i = 0; i < plugins.directories.size(); ++i)
        message += (i > 0 ? ", " : " ") + plugins.directories[i].string();
    block.problem("type", message + ")");
    return nullptr;
}

std::unique_ptr<Integrator> makeIntegrator(const LoadedScene& loaded, const Plugins& plugins) {
    const auto* entry = integratorOf(loaded.integratorSettings, loaded.integratorType, plugins);
    throwIfProblems(*loaded.diagnostics);
    auto integrator = entry->factory(loaded.scene, loaded.integratorSettings);
    loaded.integratorSettings.warnAboutUnknown();
    throwIfProblems(*loaded.diagnostics);
    return integrator;
}

/// The block's mistakes alone: for want of a scene, in an empty one.
void readIntegratorAlone(const ObjectReader& block, const std::string& type, const TransportSettings& transport,
                         const Plugins& plugins) {
    const auto* entry = integratorOf(block, type, plugins);
    if (!entry) return;
    try {
        (void)entry->factory(emptyScene(transport), block);
        block.warnAboutUnknown();
    } catch (const std::exception&) { // it takes no empty scene
    }
}

/// Of features that take light away.
void warnAboutFeatures(const Job& job) {
    Diagnostics& diagnostics = *job.loaded.diagnostics;
    for (const Feature& feature : job.features.all) {
        if (feature.on && feature.name == tungsten::feature::BlackImage)
            diagnostics.warnings.push_back({diagnostics.file, "integrator", "the image is black: " + feature.reason});
        if (feature.on && feature.name == tungsten::feature::LightCut && !job.facts.nothingArrives)
            diagnostics.warnings.push_back(
                {diagnostics.file, feature.elements.front(), feature.name + ": " + feature.reason});
    }
}

std::vector<std::filesystem::path> pluginFiles(const std::filesystem::path& directory) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("libtungsten-") && name.ends_with(".so")) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// The loader maps a library without looking whether the file has all of it, and would be killed on touching the rest.
void requireWholeLibrary(const std::filesystem::path& file) {
    const uint64_t size = requireRegularFile(file);
    const auto fail = [&](const char* why) -> InputError {
        return {file.string(), std::string("the plugin cannot be loaded: ") + why};
    };
    std::ifstream in(file, std::ios::binary);
    ElfW(Ehdr) header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!in || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_phentsize != sizeof(ElfW(Phdr)))
        throw fail("not a shared object of this machine");
    std::vector<ElfW(Phdr)> segments(header.e_phnum);
    in.seekg(std::streamoff(header.e_phoff));
    in.read(reinterpret_cast<char*>(segments.data()), std::streamsize(segments.size() * sizeof(ElfW(Phdr))));
    if (!in) throw fail("truncated");
    for (const auto& segment : segments)
        if (segment.p_offset > size || segment.p_filesz > size - segment.p_offset) throw fail("truncated");
}

void loadPlugin(const std::filesystem::path& file, IntegratorRegistry& registry) {
    requireWholeLibrary(file);
    // Never closed: factories and vtables live in the library.
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw InputError(file.string(), std::string("the plugin cannot be loaded: ") + dlerror());
    using EntryPoint = const PluginDescriptor* (*)();
    const auto entry = reinterpret_cast<EntryPoint>(dlsym(library, "tungstenPlugin"));
    if (!entry) throw InputError(file.string(), "not a plugin: it does not define tungstenPlugin()");
    const PluginDescriptor* descriptor = entry();
    if (!descriptor || !descriptor->abi || !descriptor->registerIntegrators)
        throw InputError(file.string(), "not a plugin: tungstenPlugin() returns nothing usable");
    if (std::strcmp(descriptor->abi, PluginAbi) != 0)
        throw InputError(file.string(), std::string("built for another host: the plugin has ABI '") + descriptor->abi +
                                            "', this host '" + PluginAbi + "'; rebuild it against this host's headers");
    if (descriptor->layout != pluginLayout())
        throw InputError(file.string(), "built against other headers than this host; rebuild the plugin");
    registry.setOrigin(file.string());
    descriptor->registerIntegrators(registry);
}

/// The file of the library that this is in, which may have been loaded by any program; empty if the file is gone.
std::filesystem::path hostLibrary() {
    Dl_info information{};
    std::error_code error;
    if (dladdr(reinterpret_cast<const void*>(&hostLibrary), &information) == 0) return {};
    return std::filesystem::canonical(information.dli_fname, error);
}

} // namespace

Features plannedFeatures(const Scene& scene, const Integrator& integrator, SceneFacts& facts) {
    facts = analyseScene(scene, facts.everything);
    Features features = featuresOf(scene, facts);
    integrator.plan(facts, features);
    return features;
}

Job makeJob(const std::filesystem::path& file, const LoadOptions& options, const Plugins& plugins, bool everything) {
    LoadOptions anyway = options;
    anyway.readIntegrator = [&](const ObjectReader& block, const std::string& type,
                                const TransportSettings& transport) {
        readIntegratorAlone(block, type, transport, plugins);
    };
    anyway.defaultGate = [&](const std::string& type) { return plugins.registry.defaultGateOf(type); };
    Job job{loadScene(file, anyway), nullptr, {}, {}};
    options.watch.poll();
    job.integrator = makeIntegrator(job.loaded, plugins);
    options.watch.poll();
    job.facts.everything = everything;
    job.features = plannedFeatures(*job.loaded.scene, *job.integrator, job.facts);
    warnAboutFeatures(job);
    return job;
}

std::vector<Problem> loadPlugins(const std::vector<std::filesystem::path>& directories, IntegratorRegistry& registry) {
    std::vector<Problem> problems;
    std::set<std::string> loaded; // the first directory wins
    for (const auto& directory : directories)
        for (const auto& file : pluginFiles(directory)) {
            if (!loaded.insert(file.filename().string()).second) continue;
            try {
                loadPlugin(file, registry);
            } catch (const InputError& error) {
                problems.insert(problems.end(), error.problems().begin(), error.problems().end());
            } catch (const std::exception& error) {
                problems.push_back({file.string(), "", std::string("the plugin failed to register: ") + error.what()});
            }
        }
    return problems;
}

std::vector<std::filesystem::path> pluginDirectories() {
    std::vector<std::filesystem::path> directories;
    if (const char* variable = std::getenv("TUNGSTEN_PLUGIN_PATH")) {
        std::string paths = variable;
        for (size_t start = 0; start < paths.size();) {
            const size_t end = std::min(paths.find(':', start), paths.size());
            if (end > start) directories.emplace_back(paths.substr(start, end - start));
            start = end + 1;
        }
    }
    const auto add = [&](const std::filesystem::path& directory) {
        if (directory.is_absolute() &&
            std::find(directories.begin(), directories.end(), directory) == directories.end())
            directories.push_back(directory);
    };
    std::error_code error;
    const std::filesystem::path executable = std::filesystem::read_symlink("/proc/self/exe", error);
    if (!error) add(executable.parent_path());
    const std::filesystem::path library = hostLibrary();
    if (library.empty()) return directories;
    add(library.parent_path());
    add(library.parent_path() / "tungsten");
    return directories;
}

} // namespace tungsten
