#include "support/Render.h"

#include "support/SeedShift.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/integrator/Integrator.h"
#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/Memory.h"

#include <tbb/global_control.h>

namespace tungsten::test {

double Rendered::mean(int frame) const {
    double sum = 0.0;
    for (const Rgb& pixel : film.mean(frame).pixels) sum += double(meanComponent(pixel));
    return sum / double(film.width() * film.height());
}

std::unique_ptr<Rendered> render(const std::filesystem::path& file, const RenderOptions& options,
                                 const MakeIntegrator& make) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, options.threads);
    const LoadedScene loaded = loadScene(file, {{}, options.overrides});
    auto rendered = std::make_unique<Rendered>();
    rendered->scene = loaded.scene;
    const std::unique_ptr<Integrator> integrator = make(loaded.scene, loaded.integratorSettings);
    throwIfProblems(*loaded.diagnostics);
    SceneFacts facts = analyseScene(*loaded.scene);
    Features features = featuresOf(*loaded.scene, facts);
    integrator->plan(facts, features);
    integrator->prepare(facts, {}, rendered->statistics);
    rendered->film = filmOf(*loaded.scene);
    rendered->bias = filmOf(*loaded.scene, PassWeight::Repeats);
    for (uint32_t pass = 0; pass < options.passes; ++pass) {
        PassInfo info{pass, uint64_t(pass) * options.samplesPerPass, options.samplesPerPass,
                      options.seed + seedShift()};
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
