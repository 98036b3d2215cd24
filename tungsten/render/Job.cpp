#include "tungsten/render/Job.h"

namespace tungsten {

namespace {

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

void warnAboutBlackImage(const Job& job) {
    for (const Effect& effect : job.plan.effects)
        if (effect.name == "black image")
            job.loaded.diagnostics->warnings.push_back(
                {job.loaded.diagnostics->file, "integrator", "the image is black: " + effect.reason});
}

} // namespace

Job makeJob(const std::filesystem::path& file, const LoadOptions& options, const Plugins& plugins, bool everything) {
    Job job{loadScene(file, options), nullptr, {}};
    options.watch.poll();
    job.integrator = makeIntegrator(job.loaded, plugins);
    options.watch.poll();
    job.plan = analyseScene(*job.loaded.scene, everything);
    job.integrator->plan(job.plan);
    if (job.plan.nothingArrives) warnAboutBlackImage(job);
    return job;
}

} // namespace tungsten
