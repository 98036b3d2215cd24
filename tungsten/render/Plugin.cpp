#include "tungsten/render/Plugin.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/FileBytes.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>

#include <dlfcn.h>
#include <link.h>

namespace tungsten {

namespace {

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

void IntegratorRegistry::add(const std::string& type, const std::string& description, IntegratorFactory factory) {
    const auto [position, added] = entries_.emplace(type, Entry{std::move(factory), description, origin_});
    if (!added)
        throw InputError(origin_, "registers the integrator '" + type + "', which " + position->second.origin +
                                      " registers too");
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
