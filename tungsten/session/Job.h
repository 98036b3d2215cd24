#pragma once
// A scene made ready: what the command and the Python module do with it alike.

#include "tungsten/core/Errors.h"
#include "tungsten/integrator/Plugin.h"
#include "tungsten/scene/SceneLoader.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace tungsten {

/// Loads every plugin found in `directories` (in order; of plugins with the same file name the first is taken) and
/// registers its integrators. The libraries stay loaded for the life of the process. Returns what went wrong: files
/// that cannot be loaded, lack the entry point or have another ABI.
std::vector<Problem> loadPlugins(const std::vector<std::filesystem::path>& directories, IntegratorRegistry& registry);
/// TUNGSTEN_PLUGIN_PATH's directories, then those of the executable and of the host's library.
std::vector<std::filesystem::path> pluginDirectories();

/// Integrators, what went wrong while loading them, and where they were looked for.
struct Plugins {
    IntegratorRegistry registry;
    std::vector<std::filesystem::path> directories = pluginDirectories();
    std::vector<Problem> problems = loadPlugins(directories, registry);
};

/// A scene with its integrator, and what it will do.
struct Job {
    LoadedScene loaded;
    std::unique_ptr<Integrator> integrator;
    SceneFacts facts;
    Features features;
};

/// What an integrator does for a scene, and why, with what its pilots have chosen if it is prepared. Of `facts` only
/// `everything` is read; they become what the integrator leaves of them.
Features plannedFeatures(const Scene& scene, const Integrator& integrator, SceneFacts& facts);

/// Throws what loadScene throws, and InputError for an integrator that nobody registers or that refuses its settings.
/// `everything`: SceneFacts::everything.
Job makeJob(const std::filesystem::path& file, const LoadOptions& options, const Plugins& plugins,
            bool everything = false);

} // namespace tungsten
