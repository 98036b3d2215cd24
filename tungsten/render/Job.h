#pragma once
// A scene made ready: what the command and the Python module do with it alike.

#include "tungsten/render/Plugin.h"
#include "tungsten/scene/SceneLoader.h"

namespace tungsten {

/// Integrators, what went wrong while loading them, and where they were looked for.
struct Plugins {
    IntegratorRegistry registry;
    std::vector<std::filesystem::path> directories = pluginDirectories();
    std::vector<Problem> problems = loadPlugins(directories, registry);
};

/// A scene with its integrator, whose plan is complete.
struct Job {
    LoadedScene loaded;
    std::unique_ptr<Integrator> integrator;
    EffectPlan plan;
};

/// Throws what loadScene throws, and InputError for an integrator that nobody registers or that refuses its settings.
/// `everything`: EffectPlan::everything.
Job makeJob(const std::filesystem::path& file, const LoadOptions& options, const Plugins& plugins,
            bool everything = false);

} // namespace tungsten
