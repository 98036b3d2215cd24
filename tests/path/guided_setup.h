#pragma once
// Everything that a guided path, and a plain one beside it, needs of a scene.

#include "path/GuidedPath.h"
#include "path/PathPlan.h"
#include "path/PathVisitor.h"
#include "path/PlainTrail.h"
#include "path/techniques/LightCaches.h"
#include "transport/SharePilot.h"

#include "support/SceneFile.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/scene/SceneLoader.h"

namespace tungsten::path {

struct GuidedSetup {
    explicit GuidedSetup(const std::string& json) : file(json), loaded(loadScene(file.path())) {
        facts.excludedEmitters.resize(scene.emitters.size());
    }
    GuidedSetup(const GuidedSetup&) = delete;
    GuidedSetup& operator=(const GuidedSetup&) = delete;

    [[nodiscard]] GuidedContext guided() const {
        return {scene, settings,           sensor, windows, guides,       lightCaches,
                bound, escapeModels.get(), true,   watch,   {0.5f, 0.5f}, &targets};
    }
    [[nodiscard]] PathContext plain() const { return {scene, settings, lights, bound, nullptr, true, watch}; }

    test::SceneFile file;
    LoadedScene loaded;
    const Scene& scene = *loaded.scene;
    PathSettings settings = readPathSettings(loaded.integratorSettings, scene);
    SceneFacts facts = analyseScene(scene);
    ProgressToken watch;
    transport::TimeSensor sensor = transport::TimeSensor::of(scene, scene.transport.gate);
    transport::TimeWindows windows{sensor.arrivals};
    PathGuides guides = PathGuides::of(scene, settings.policy, facts, watch);
    LightCaches lightCaches; ///< none
    ArrivalBound bound{scene, facts};
    std::unique_ptr<const transport::EscapeModels> escapeModels = transport::EscapeModels::make(scene, settings.policy);
    TargetChoice targets{scene, TargetChoice::Emitters::All, {}, true};
    LightChoice lights{scene, std::vector<bool>(scene.emitters.size())};
};

struct PixelMean {
    Rgb value;
    double mean, error; ///< of all channels together
};
/// Of passes of one pixel, by trace(sink, counters, i) of the i-th path.
template <typename Trace>
PixelMean meanOfPaths(const GuidedSetup& setup, uint32_t passes, uint32_t paths, const Trace& trace) {
    PathCounters counters;
    Film film(1, 1, 1);
    uint32_t traced = 0;
    for (uint32_t pass = 0; pass < passes; ++pass) {
        film.beginPass();
        {
            PixelAccumulator sink(film, setup.sensor, 0, 0, paths, counters);
            for (uint32_t i = 0; i < paths; ++i, ++traced) trace(sink, counters, traced);
        }
        film.endPass(double(paths));
    }
    return {film.mean(0).at(0, 0), meanValue(film), relativeStandardError(film) * meanValue(film)};
}

} // namespace tungsten::path
