
#include "tungsten/session/Report.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/io/Format.h"
#include "tungsten/io/Result.h"
#include "tungsten/reader/Json.h"
#include "tungsten/scene/JsonWriter.h"
#include "tungsten/session/Progress.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <ostream>

namespace tungsten {

namespace {

/// Whether the feature is that of excluding something, and does.
bool excludes(const Feature& feature, const SceneFacts& facts) {
    const bool surfaces = facts.surfaceScattering || facts.surfaceEmission || facts.specularCameraSubpaths;
    if (feature.name == tungsten::feature::SurfacesInTime) return surfaces && facts.surfacesOutOfTime;
    if (feature.name == tungsten::feature::MediaInTime) return !facts.excludedMedia.empty();
    using namespace tungsten::feature;
    return feature.on && std::ranges::any_of(std::array{LateEmitters, BlackImage, EmptyFrames, LightCut},
                                             [&](const FeatureName& name) { return feature.name == name; });
}

using Descriptions = std::vector<std::shared_ptr<Description>>;

/// The reader of scenes takes any type: which there are the registry alone knows, with those of plugins.
void nameTypes(std::vector<Field>& fields, const IntegratorRegistry& registry) {
    std::vector<std::string> types;
    for (const auto& [type, entry] : registry.entries()) types.push_back(type);
    for (Field& field : fields)
        if (field.name == "type") field.accepted = listOf(types);
}

/// The same of images: the table of formats knows which there are.
void nameFormats(std::vector<Field>& fields) {
    for (Field& field : fields) {
        if (field.meaning == meaning::ToneMappedImage || field.meaning == meaning::EightBitImage)
            field.meaning += " (" + formatsText(output_use::Shown) + ")";
        if (field.meaning == meaning::LinearImage) field.meaning += " (" + formatsWithNotes(output_use::Linear) + ")";
    }
}

std::shared_ptr<Description> describeIntegrator(const std::string& type, const IntegratorRegistry& registry,
                                                const std::shared_ptr<const Scene>& scene) {
    const IntegratorRegistry::Entry& entry = registry.entries().at(type);
    auto description = std::make_shared<Description>();
    description->name = type;
    description->note = entry.description;
    const ObjectReader reader = ObjectReader::describing(description, type);
    describeTransport(reader, entry.traits.defaultGate);
    nameTypes(description->fields, registry);
    try {
        (void)entry.factory(scene, reader);
    } catch (const std::exception& error) {
        description->note +=
            " (fields may be missing: it does not take an empty scene: " + std::string(error.what()) + ")";
    }
    return description;
}

/// Adds the blocks within `description`, once each.
void collectBlocks(const Description& description, Descriptions& blocks) {
    for (const auto& block : description.blocks) {
        const bool known = std::any_of(blocks.begin(), blocks.end(), [&](const std::shared_ptr<Description>& other) {
            return other->name == block->name && other->fields == block->fields;
        });
        if (!known) blocks.push_back(block);
        collectBlocks(*block, blocks);
    }
}

bool isCountOrLength(const Field& field) {
    const bool counted = field.unit == "none" || field.unit == "length" || field.unit == "samples/pixel";
    return counted && field.fallback != "0" && field.accepted.find("number") != std::string::npos;
}

/// The reason of a feature whose element is the field: what was made for the scene.
std::string madeFor(const Features& features, const std::string& field) {
    const auto feature = std::ranges::find_if(features.all, [&](const Feature& described) {
        return std::ranges::find(described.elements, field) != described.elements.end();
    });
    return feature == features.all.end() ? "" : feature->reason;
}

std::string subtitle(const LoadedScene& loaded, const SessionResult& result) {
    const TimeGate& gate = loaded.scene->transport.gate;
    char text[200];
    std::snprintf(text, sizeof text, "%s, %d x %d pixels, %s, %u passes, %.1f s (%s)", loaded.integratorType.c_str(),
                  result.film.width(), result.film.height(),
                  gate.steadyState  ? "steady state"
                  : gate.delta      ? "a single moment"
                  : gate.frames > 1 ? (std::to_string(gate.frames) + " frames").c_str()
                                    : "one time gate",
                  result.film.passes(), result.renderSeconds, toString(result.reason).c_str());
    return text;
}

} // namespace

void printPlan(const SceneFacts& facts, const Features& features, std::ostream& out) {
    out << "  paths     " << features.sampling.paths << "\n  vertices  " << features.sampling.vertices
        << "\n  ends      " << features.sampling.ends << '\n';
    for (const std::string& limitation : features.limitations) out << "  lacks     " << limitation << '\n';
    for (const Feature& feature : features.all)
        if (excludes(feature, facts)) out << "  left out  " << feature.name << ": " << feature.reason << '\n';
}

void printFeatures(const Features& features, std::ostream& out) {
    size_t width = 0;
    for (const Feature& feature : features.all) width = std::max(width, feature.name.size());
    for (const Feature& feature : features.all)
        out << "  " << (feature.on ? "on " : "off") << "  " << std::left << std::setw(int(width)) << feature.name
            << "  " << feature.reason << '\n';
}

void writeFeatures(const std::vector<Feature>& features, const Statistics& statistics, JsonWriter& json) {
    json.beginArray("effects");
    for (const Feature& feature : features) {
        json.beginObject();
        json.field("name", feature.name);
        json.field("on", feature.on);
        json.field("reason", feature.reason);
        json.field("causes", feature.elements);
        json.beginObject("counters");
        for (const std::string& counter : feature.counters) json.field(counter, statistics.counter(counter));
        json.endObject();
        json.endObject();
    }
    json.endArray();
}

void printDefaults(const std::vector<DefaultTaken>& defaults, std::ostream& out) {
    size_t width = 0;
    for (const DefaultTaken& taken : defaults) width = std::max(width, taken.field.size());
    if (!defaults.empty()) out << "what the scene leaves open\n";
    for (const DefaultTaken& taken : defaults)
        out << "  " << std::left << std::setw(int(width)) << taken.field << "  " << taken.value << " (" << taken.meaning
            << ")\n";
}

std::string planJson(const Job& job, const std::vector<DefaultTaken>& defaults) {
    JsonWriter json;
    json.field("scene", job.loaded.scene->file.string());
    json.field("integrator", job.loaded.integratorType);
    json.beginObject("sampling");
    json.field("paths", job.features.sampling.paths);
    json.field("vertices", job.features.sampling.vertices);
    json.field("ends", job.features.sampling.ends);
    json.endObject();
    writeFeatures(job.features.all, {}, json);
    json.field("lacks", job.features.limitations);
    json.beginArray("defaults");
    for (const DefaultTaken& taken : defaults) {
        json.beginObject();
        json.field("field", taken.field);
        json.field("value", taken.value);
        json.field("meaning", taken.meaning);
        json.endObject();
    }
    json.endArray();
    return json.finish();
}

std::vector<DescribedKind> describeAll(const IntegratorRegistry& registry) {
    std::vector<DescribedKind> kinds = describeScene();
    const std::shared_ptr<const Scene> scene = emptyScene();
    DescribedKind integrators{"integrators", {}};
    for (const auto& [type, entry] : registry.entries())
        integrators.types.push_back(describeIntegrator(type, registry, scene));
    kinds.insert(kinds.begin() + 1, std::move(integrators));
    Descriptions blocks = kinds.front().types;
    for (const DescribedKind& kind : kinds)
        for (const auto& type : kind.types) collectBlocks(*type, blocks);
    for (const auto& block : blocks) nameFormats(block->fields);
    kinds.front().types = std::move(blocks);
    return kinds;
}

std::vector<DescribedKind> selectDescriptions(const std::vector<DescribedKind>& all, const std::string& name) {
    if (name.empty()) return all;
    std::vector<DescribedKind> selected;
    std::vector<std::string> names;
    for (const DescribedKind& kind : all) {
        names.push_back(kind.kind);
        DescribedKind part{kind.kind, {}};
        for (const auto& type : kind.types) {
            names.push_back(type->name);
            if (name == type->name || name == kind.kind) part.types.push_back(type);
        }
        if (!part.types.empty()) selected.push_back(std::move(part));
    }
    if (!selected.empty()) return selected;
    const std::string near = nearestName(name, names);
    throw UsageError("--describe " + name + ": no such type" + (near.empty() ? "" : "; did you mean '" + near + "'?") +
                     " (--list shows all)");
}

std::vector<DefaultTaken> defaultsTaken(const Job& job, const IntegratorRegistry& registry) {
    const auto document = parseJson(job.loaded.text, job.loaded.diagnostics->file);
    const ObjectReader root(document, nodeOf(*document), "", std::make_shared<Diagnostics>());
    const auto described = describeAll(registry);
    std::vector<DefaultTaken> taken;
    for (const auto& [block, type] : {std::pair<std::string, std::string>{"integrator", job.loaded.integratorType},
                                      std::pair<std::string, std::string>{"renderer", "renderer"}}) {
        const auto given = root.object(block, {"none", ""});
        for (const DescribedKind& kind : selectDescriptions(described, type))
            for (const auto& description : kind.types)
                for (const Field& field : description->fields) {
                    if (!isCountOrLength(field) || (given && given->has(field.name))) continue;
                    const std::string path = block + "." + field.name, made = madeFor(job.features, path);
                    taken.push_back({path, made.empty() ? field.fallback : made, field.meaning});
                }
    }
    return taken;
}

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
    const auto prepare = stages.find(stage::Prepare);
    const double preparing = prepare == stages.end() ? 0.0 : prepare->second.wallSeconds;
    std::string why = "not one pass ended within " + text("%.3g s", limit);
    if (preparing >= 0.9 * limit) {
        why += ", which went into preparing";
        if (!stages.contains(stage::Passes) && !result.brokenOff.stage.empty())
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
    json.field("relative standard error", relativeStandardError(result.film));
    json.field("relative error bound", relativeErrorBound(result.film));
    if (result.estimatesBias()) {
        const RelativeBias bias = result.relativeBias();
        json.field("relative bias", bias.estimate);
        json.field("relative bias bound", bias.bound);
        json.field("passes measured for bias", uint64_t(result.bias.passes()));
    }
    json.field(counter::NonFiniteSamples,
               result.film.nonFiniteSamples() + result.statistics.counter(counter::NonFiniteSamples));
    json.field("render wall seconds", result.renderSeconds);
    if (result.ranks > 1) json.field("ranks", uint64_t(result.ranks));
    json.field("process CPU seconds", processCpuSeconds() + result.othersCpuSeconds);
    json.field("peak memory bytes", std::max(peakMemoryBytes(), uint64_t(result.othersPeakMemory)));
    writeFeatures(result.features, result.statistics, json);
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

std::optional<Problem> blackImage(const Scene& scene, const SceneFacts& facts, const Features& features,
                                  const SessionResult& result) {
    if (facts.nothingArrives || result.film.passes() == 0 || !(meanSquare(result.film) == 0.0)) return std::nullopt;
    const TransportSettings& transport = scene.transport;
    std::string text = "the image is black: no path found light";
    for (const std::string& limitation : features.limitations) text += "; it lacks " + limitation;
    if (transport.minBounces >= transport.maxBounces)
        text += "; min_bounces and max_bounces leave no number of interactions between them";
    else if (!facts.timeResolved)
        text += "; look at where lights and camera stand, what lies between them, and at max_bounces";
    else
        text += "; look at the times of the gate (a film of many frames shows when light arrives)";
    if (facts.timeResolved && !transport.cameraUnwarped)
        text += "; they count the way to the camera, unless the scene says \"camera_unwarped\": true";
    return Problem{scene.file.string(), "integrator", text};
}

PageContent pageOf(const LoadedScene& loaded, const SessionOptions& options, const SessionResult& result) {
    const double error = relativeStandardError(result.film);
    const std::string known =
        std::isnan(error) ? "" : errorText(error, relativeErrorBound(result.film), result.relativeBias());
    PageContent content{
        result.film,
        *loaded.scene,
        loaded.integratorType,
        subtitle(loaded, result),
        {{"error", known}, {"command", options.command}, {"machine", machineText()}, {"build", buildText()}},
        {},
        statisticsJson(loaded, options, result)};
    for (const TraceEntry& entry : result.trace)
        content.curve.push_back({entry.cpuSeconds, entry.wallSeconds, entry.relativeError});
    return content;
}

} // namespace tungsten
