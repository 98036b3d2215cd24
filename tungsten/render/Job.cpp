#include "tungsten/render/Job.h"

#include "tungsten/render/BounceCuts.h"
#include "tungsten/scene/FormatTypes.h"

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

/// Of effects that take light away.
void warnAboutEffects(const Job& job) {
    Diagnostics& diagnostics = *job.loaded.diagnostics;
    for (const Effect& effect : job.plan.effects) {
        if (effect.on && effect.name == "black image")
            diagnostics.warnings.push_back({diagnostics.file, "integrator", "the image is black: " + effect.reason});
        if (effect.on && effect.name == LightCut && !job.plan.nothingArrives)
            diagnostics.warnings.push_back(
                {diagnostics.file, effect.causes.front(), effect.name + ": " + effect.reason});
    }
}

} // namespace

Job makeJob(const std::filesystem::path& file, const LoadOptions& options, const Plugins& plugins, bool everything) {
    LoadOptions anyway = options;
    anyway.readIntegrator = [&](const ObjectReader& block, const std::string& type,
                                const TransportSettings& transport) {
        readIntegratorAlone(block, type, transport, plugins);
    };
    Job job{loadScene(file, anyway), nullptr, {}};
    options.watch.poll();
    job.integrator = makeIntegrator(job.loaded, plugins);
    options.watch.poll();
    job.plan = analyseScene(*job.loaded.scene, everything);
    job.integrator->plan(job.plan);
    warnAboutEffects(job);
    return job;
}

} // namespace tungsten
