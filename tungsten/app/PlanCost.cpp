#include "tungsten/app/PlanCost.h"

#include "tungsten/core/Errors.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/scene/JsonWriter.h"
#include "tungsten/session/CostPilot.h"

#include <tbb/global_control.h>

#include <cstdio>
#include <optional>

namespace tungsten {

namespace {

constexpr double Errors[] = {0.1, 0.03, 0.01, 0.003};
constexpr double DefaultSeconds = 12.0; // of all methods

struct Method {
    std::string name;
    std::vector<std::string> settings; ///< as --set takes them
    std::string refusal{};             ///< why it cannot render the scene
    std::optional<PassCosts> costs{};

    [[nodiscard]] std::optional<double> passesFor(double error) const {
        return costs ? costs->passesFor(error) : std::nullopt;
    }
};

/// Points, beams, sliced primitives and paths, with the scene's own sampling, or the best where it says nothing.
std::vector<Method> methodsFor(const LoadedScene& loaded, const IntegratorRegistry& registry) {
    const auto own = registry.entries().find(loaded.integratorType);
    const bool photonMap = own != registry.entries().end() && own->second.traits.family == IntegratorFamily::PhotonMaps;
    const std::string type = "integrator.type=";
    const std::string map = type + (photonMap ? loaded.integratorType : registry.typeOf(IntegratorFamily::PhotonMaps));
    const std::string sliced = loaded.scene->transport.gate.steadyState ? "volumes" : "mis_volumes_balls";
    std::vector<Method> methods;
    for (const std::string& primitive : {std::string("points"), std::string("beams"), sliced})
        methods.push_back({primitive, {map, "integrator.volume_photon_type=" + primitive}});
    methods.push_back({"paths", {type + registry.typeOf(IntegratorFamily::PathTracers)}});
    if (!loaded.integratorSettings.has("darts"))
        for (Method& method : methods) method.settings.emplace_back("integrator.darts=best");
    return methods;
}

LoadOptions loadOptions(const Options& options, const std::vector<std::string>& more) {
    LoadOptions load{options.inputDirectory, options.overrides, options.outputs.allowOutside};
    load.overrides.insert(load.overrides.end(), more.begin(), more.end());
    return load;
}

void measure(Method& method, const std::filesystem::path& file, const Options& options, const Plugins& plugins,
             double seconds, const std::atomic<bool>& interrupted) {
    try {
        const Job job = makeJob(file, loadOptions(options, method.settings), plugins);
        if (!job.features.limitations.empty()) {
            method.refusal = "lacks " + job.features.limitations.front();
            return;
        }
        method.costs = measurePasses(*job.loaded.scene, *job.integrator, job.facts,
                                     {.seed = options.seed,
                                      .samplesPerPass = uint32_t(job.loaded.renderer.sppStep),
                                      .seconds = seconds,
                                      .mostSeconds = 2.0 * seconds,
                                      .interrupted = &interrupted});
        if (!method.costs) method.refusal = "black: nothing arrived in the passes of the pilot";
    } catch (const InputError& error) {
        const Problem& first = error.problems().front();
        method.refusal = first.path.empty() ? first.message : first.path + ": " + first.message;
    }
}

/// The method of least CPU seconds; none if no method gets there.
const Method* cheapest(const std::vector<Method>& methods, double error) {
    const Method* best = nullptr;
    double least = Infinity;
    for (const Method& method : methods) {
        const auto passes = method.passesFor(error);
        if (!passes || method.costs->cpuSecondsFor(*passes) >= least) continue;
        least = method.costs->cpuSecondsFor(*passes);
        best = &method;
    }
    return best;
}

void printTable(const std::string& scene, const std::vector<Method>& methods, size_t threads) {
    std::printf("%s: CPU seconds (seconds on %zu threads) until noise and bias are\n%-18s", scene.c_str(), threads, "");
    for (const double error : Errors) std::printf(" %20.3g %%", 100.0 * error);
    std::printf("\n");
    for (const Method& method : methods) {
        std::printf("%-18s", method.name.c_str());
        if (!method.costs) {
            std::printf("   %s\n", method.refusal.c_str());
            continue;
        }
        for (const double error : Errors) {
            char text[64] = "never";
            if (const auto passes = method.passesFor(error))
                std::snprintf(text, sizeof text, "%.3g (%.3g)", method.costs->cpuSecondsFor(*passes),
                              method.costs->wallSecondsFor(*passes));
            std::printf(" %22s", text);
        }
        std::printf("\n");
    }
    std::printf("%-18s", "cheapest");
    for (const double error : Errors) {
        const Method* best = cheapest(methods, error);
        std::printf(" %22s", best ? best->name.c_str() : "none");
    }
    std::printf("\n");
    std::fflush(stdout);
}

void writeLaw(JsonWriter& json, const std::string& name, const PowerLaw& law) {
    json.beginObject(name);
    json.field("first", law.first);
    json.field("exponent", law.exponent);
    json.endObject();
}

void writeMethod(JsonWriter& json, const Method& method) {
    json.beginObject();
    json.field("name", method.name);
    std::string settings;
    for (const std::string& setting : method.settings) settings += (settings.empty() ? "" : " ") + setting;
    json.field("settings", settings);
    if (!method.costs) {
        json.field("refused because", method.refusal);
        return json.endObject();
    }
    json.field("passes of the pilot", uint64_t(method.costs->passes));
    writeLaw(json, "relative variance of a pass", method.costs->variance);
    writeLaw(json, "relative bias of a pass", method.costs->bias);
    writeLaw(json, "CPU seconds of a pass", method.costs->cpuSeconds);
    json.field("CPU seconds before the first", method.costs->prepareCpuSeconds);
    json.beginArray("prices");
    for (const double error : Errors) {
        json.beginObject();
        json.field("error", error);
        const double passes = method.passesFor(error).value_or(NAN); // null: never
        json.field("passes", passes);
        json.field("CPU seconds", std::isnan(passes) ? NAN : method.costs->cpuSecondsFor(passes));
        json.field("wall seconds", std::isnan(passes) ? NAN : method.costs->wallSecondsFor(passes));
        json.endObject();
    }
    json.endArray();
    json.endObject();
}

std::string costJson(const std::string& scene, const std::vector<Method>& methods, size_t threads) {
    JsonWriter json;
    json.field("scene", scene);
    json.field("threads", uint64_t(threads));
    json.beginArray("methods");
    for (const Method& method : methods) writeMethod(json, method);
    json.endArray();
    json.beginArray("cheapest");
    for (const double error : Errors) {
        const Method* best = cheapest(methods, error);
        json.beginObject();
        json.field("error", error);
        json.field("method", best ? best->name : "");
        json.endObject();
    }
    json.endArray();
    return json.finish();
}

} // namespace

bool planCost(const std::filesystem::path& file, const Options& options, const Plugins& plugins,
              const std::atomic<bool>& interrupted) {
    LoadOptions load = loadOptions(options, {});
    load.defaultGate = [&](const std::string& type) { return plugins.registry.defaultGateOf(type); };
    const LoadedScene loaded = loadScene(file, load);
    const std::filesystem::path report = options.outputs.placed(options.outputs.statistics.value_or(""));
    if (!report.empty()) checkWritable(report, std::nullopt);
    std::vector<Method> methods = methodsFor(loaded, plugins.registry);
    try {
        const double seconds = options.timeoutSeconds.value_or(DefaultSeconds) / double(methods.size());
        for (Method& method : methods) measure(method, file, options, plugins, seconds, interrupted);
    } catch (const PassCancelled&) {
        return false;
    }
    const size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    printTable(file.string(), methods, threads);
    if (!report.empty()) writeTextFile(report, costJson(file.string(), methods, threads));
    for (const Method& method : methods)
        if (method.costs) return true;
    throw InputError(file.string(), "no method can tell what an error costs: " + methods.front().refusal);
}

} // namespace tungsten
