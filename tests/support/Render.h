#pragma once
// Rendering small scenes inside a test.

#include "support/SceneFile.h"

#include "tungsten/film/KernelBias.h"
#include "tungsten/render/Integrator.h"
#include "tungsten/render/SceneFilm.h"
#include "tungsten/scene/SceneLoader.h"

#include <tbb/global_control.h>

#include <memory>
#include <string>
#include <vector>

namespace tungsten::test {

struct RenderOptions {
    std::vector<std::string> overrides;
    uint32_t passes = 16;
    uint32_t samplesPerPass = 1;
    uint64_t seed = 1;
    size_t threads = 2;
    bool bias = false; ///< estimate what kernels leave
};

struct Rendered {
    std::shared_ptr<const Scene> scene;
    Film film, bias;
    Statistics statistics;

    /// Mean over the image of one frame's channel average, and its standard error from the spread of the passes.
    [[nodiscard]] double mean(int frame = 0) const {
        double sum = 0.0;
        for (const Rgb& pixel : film.mean(frame).pixels) sum += double(meanComponent(pixel));
        return sum / double(film.width() * film.height());
    }
    /// Of a single-pixel image (pixels of one pass share photons, so larger images need their own estimate).
    [[nodiscard]] double pixelError(int frame = 0) const { return double(film.standardError(frame).at(0, 0).y); }
};

/// `make(scene, settings)` makes the integrator.
template <typename Make>
std::unique_ptr<Rendered> render(const std::filesystem::path& file, const RenderOptions& options, Make make) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, options.threads);
    const LoadedScene loaded = loadScene(file, {{}, options.overrides});
    auto rendered = std::make_unique<Rendered>();
    rendered->scene = loaded.scene;
    const std::unique_ptr<Integrator> integrator = make(loaded.scene, loaded.integratorSettings);
    throwIfProblems(*loaded.diagnostics);
    EffectPlan plan = analyseScene(*loaded.scene);
    integrator->plan(plan);
    integrator->prepare(plan, rendered->statistics);
    rendered->film = filmOf(*loaded.scene);
    rendered->bias = filmOf(*loaded.scene, PassWeight::Repeats);
    for (uint32_t pass = 0; pass < options.passes; ++pass) {
        PassInfo info{pass, uint64_t(pass) * options.samplesPerPass, options.samplesPerPass, options.seed};
        const uint32_t standsFor = options.bias ? passesOfItsBias(pass) : 0;
        if (standsFor > 0) info.bias = &rendered->bias;
        rendered->film.beginPass();
        rendered->bias.beginPass();
        integrator->renderPass(info, rendered->film, rendered->statistics);
        rendered->film.endPass(double(options.samplesPerPass));
        if (standsFor > 0) rendered->bias.endPass(double(standsFor));
    }
    return rendered;
}

} // namespace tungsten::test
