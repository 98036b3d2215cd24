#include "path/PathGuides.h"

#include "path/Tuning.h"

namespace tungsten::path {

PathGuides PathGuides::of(const Scene& scene, const darts::SamplingOptions& options, const SceneFacts& facts,
                          const ProgressToken& watch) {
    PathGuides guides;
    watch.stage("guides of media", scene.media.size());
    for (size_t i = 0; i < scene.media.size(); ++i) {
        watch.advance();
        const Medium& medium = scene.media[i];
        darts::Settings settings =
            options.settings(darts::Mode::Path, medium.phase.g(), medium.guided, medium.guidedPhase);
        // Directions are guided for the sake of control vertices.
        if (!medium.scatters() || facts.isExcluded(i) || (!options.elliptical && !options.direction))
            settings.direction = darts::Direction::Phase;
        const darts::Medium coefficients{darts::vec3(medium.sigmaA()), darts::vec3(medium.sigmaS()), medium.phase.g()};
        guides.media.emplace_back(settings, coefficients);
        darts::Settings glossy = settings;
        if (!options.published) glossy.alpha = std::max(glossy.alpha, tuning::GlossyAlpha);
        guides.glossy.emplace_back(glossy, coefficients);
    }
    return guides;
}

} // namespace tungsten::path
