// The report of `--stats`.

#include "tungsten/render/PlanReport.h"
#include "tungsten/render/RenderSession.h"
#include "tungsten/scene/JsonWriter.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>

namespace tungsten {

std::string toString(StopReason reason) {
    switch (reason) {
    case StopReason::Finished:
        return "all samples taken";
    case StopReason::TimedOut:
        return "time-out";
    case StopReason::TargetReached:
        return "target error reached";
    case StopReason::Interrupted:
        return "interrupted";
    }
    return "";
}

std::string whyNoPass(const SessionOptions& options, const SessionResult& result) {
    const auto text = [](const char* format, double number) {
        char buffer[64];
        std::snprintf(buffer, sizeof buffer, format, number);
        return std::string(buffer);
    };
    const double limit = options.timeoutSeconds;
    const auto stages = result.statistics.stages();
    const auto prepare = stages.find("prepare");
    const double preparing = prepare == stages.end() ? 0.0 : prepare->second.wallSeconds;
    std::string why = "not one pass ended within " + text("%.3g s", limit);
    if (preparing >= 0.9 * limit) {
        why += ", which went into preparing";
        if (!stages.contains("passes") && !result.brokenOff.stage.empty())
            why += " (" + result.brokenOff.stage + text(", %.0f %% done)", 100.0 * result.brokenOff.ofStage);
        return why + "; nothing was written. Give it more time: that is spent before the first photon or sample";
    }
    if (preparing >= 0.5 * limit) why += text(", of which %.2g s went into preparing", preparing);
    return why + "; nothing was written. Give it more time, a smaller resolution, fewer samples in a pass "
                 "(renderer.spp_step) or fewer photons";
}

std::string statisticsJson(const LoadedScene& loaded, const SessionOptions& options, const SessionResult& result) {
    const Scene& scene = *loaded.scene;
    JsonWriter json;
    json.field("scene", scene.file.string());
    json.field("integrator", loaded.integratorType);
    json.field("width", uint64_t(scene.camera.resolution.x));
    json.field("height", uint64_t(scene.camera.resolution.y));
    json.field("frames", uint64_t(scene.transport.gate.frames));
    json.field("seed", options.seed);
    json.field("threads", uint64_t(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
    json.field("passes", uint64_t(result.film.passes()));
    const double taken = result.film.totalWeight(); // parts of samples where passes were cut
    taken == double(result.samples) ? json.field("samples per pixel", result.samples)
                                    : json.field("samples per pixel", taken);
    json.field("resumed samples per pixel", result.resumedSamples);
    json.field("stopped because", toString(result.reason));
    if (options.targetError > 0.0) {
        json.field("target error", options.targetError);
        json.field("target error reached", result.errorBound() <= options.targetError);
    }
    json.field("relative standard error", result.film.relativeStandardError());
    json.field("relative error bound", result.film.relativeErrorBound());
    if (result.estimatesBias()) {
        const RelativeBias bias = result.relativeBias();
        json.field("relative bias", bias.estimate);
        json.field("relative bias bound", bias.bound);
        json.field("passes measured for bias", uint64_t(result.bias.passes()));
    }
    json.field("non-finite samples", result.film.nonFiniteSamples() + result.statistics.counter("non-finite samples"));
    json.field("render wall seconds", result.renderSeconds);
    if (result.ranks > 1) json.field("ranks", uint64_t(result.ranks));
    json.field("process CPU seconds", processCpuSeconds() + result.othersCpuSeconds);
    json.field("peak memory bytes", std::max(peakMemoryBytes(), uint64_t(result.othersPeakMemory)));
    writeEffects(result.effects, result.statistics, json);
    json.beginObject("counters");
    for (const auto& [name, value] : result.statistics.counters()) json.field(name, value);
    json.endObject();
    json.beginObject("stages");
    for (const auto& [name, stage] : result.statistics.stages()) {
        json.beginObject(name);
        json.field("wall seconds", stage.wallSeconds);
        json.field("CPU seconds", stage.cpuSeconds);
        json.field("runs", stage.runs);
        json.endObject();
    }
    json.endObject();
    return json.finish();
}

} // namespace tungsten
