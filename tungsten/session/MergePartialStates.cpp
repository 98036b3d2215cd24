// Partial states put together.

#include "tungsten/core/Errors.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/scene/JsonWriter.h"
#include "tungsten/session/Memory.h"
#include "tungsten/session/PartialState.h"

#include <algorithm>

namespace tungsten {

namespace {

namespace fs = std::filesystem;

/// "pass 3", "passes 3 to 5".
std::string passesText(uint32_t first, uint32_t end) {
    return end - first == 1 ? "pass " + std::to_string(first)
                            : "passes " + std::to_string(first) + " to " + std::to_string(end - 1);
}

/// What keeps states, in the order of their passes, from being one render.
std::vector<Problem> problemsOf(const std::vector<std::unique_ptr<PartialStateReader>>& states) {
    std::vector<Problem> problems;
    const auto add = [&](const PartialStateReader& state, const std::string& message) {
        problems.push_back({state.file().string(), "", message});
    };
    uint32_t end = 0;
    const PartialStateReader *before = nullptr, &first = *states.front();
    for (const auto& state : states) {
        const std::string difference = state->differenceTo(first);
        if (!difference.empty()) {
            add(*state, "belongs to a render with another " + difference + " than " + first.file().string());
            continue;
        }
        if (state->first() > end)
            add(*state, passesText(end, state->first()) + " before its own are missing: no state holds them");
        if (before && state->first() < end)
            add(*state, "holds " + passesText(state->first(), state->end()) + ", and " + before->file().string() + " " +
                            passesText(before->first(), before->end()) + ": they overlap");
        for (size_t i = 0; i < state->samples().size(); ++i)
            if (int64_t(state->samples()[i]) != state->identity().sppStep &&
                (i + 1 < state->samples().size() || state != states.back()))
                add(*state, passesText(state->first() + uint32_t(i), state->first() + uint32_t(i) + 1) +
                                " is the last of a render with fewer samples (spp) than the others");
        if (!before || state->end() > end) before = state.get();
        end = std::max(end, state->end());
    }
    return problems;
}

std::string statisticsOf(const MergedRender& merged, const std::vector<std::unique_ptr<PartialStateReader>>& states) {
    JsonWriter json;
    double cpuSeconds = 0.0;
    for (const auto& state : states) cpuSeconds += state->cpuSeconds();
    json.field("scene", merged.identity.scene->file.string());
    json.field("integrator", merged.identity.integrator);
    json.field("seed", merged.identity.seed);
    json.field("passes", uint64_t(merged.film.passes()));
    json.field("samples per pixel", merged.samples);
    json.field("relative standard error", relativeStandardError(merged.film));
    json.field("relative error bound", relativeErrorBound(merged.film));
    json.field("process CPU seconds", cpuSeconds);
    json.beginArray("states");
    for (const auto& state : states) {
        json.beginObject();
        json.field("file", state->file().string());
        json.field("first pass", uint64_t(state->first()));
        json.jsonField("statistics", state->statistics());
        json.endObject();
    }
    json.endArray();
    return json.finish();
}

} // namespace

MergedRender mergePartialStates(const std::vector<fs::path>& files) {
    std::vector<std::unique_ptr<PartialStateReader>> states;
    std::vector<Problem> problems;
    for (const fs::path& file : files) {
        try {
            states.push_back(std::make_unique<PartialStateReader>(file));
        } catch (const InputError& error) {
            problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        }
    }
    std::stable_sort(states.begin(), states.end(),
                     [](const auto& a, const auto& b) { return a->first() < b->first(); });
    if (problems.empty()) problems = problemsOf(states);
    if (!problems.empty()) throw InputError(problems);
    MergedRender merged{states.front()->identity(), {}, 0, {}};
    const Scene& scene = *merged.identity.scene;
    merged.film = filmOf(scene);
    for (const auto& state : states) {
        state->fold(merged.film);
        for (const uint32_t samples : state->samples()) merged.samples += samples;
    }
    merged.statistics = statisticsOf(merged, states);
    return merged;
}

} // namespace tungsten
