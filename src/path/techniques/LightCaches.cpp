#include "path/techniques/LightCaches.h"

#include "path/Tuning.h"

#include "tungsten/integrator/Names.h"

namespace tungsten::path {

namespace {

/// Extinction of the scene's scattering media, on the average.
Flights flightsIn(const Scene& scene) {
    float sum = 0.0f;
    int count = 0;
    for (const Medium& medium : scene.media) {
        if (!medium.scatters()) continue;
        sum += meanComponent(medium.sigmaT());
        ++count;
    }
    return {count > 0 ? sum / float(count) : 1.0f};
}

} // namespace

bool LightCaches::helpWith(const Scene& scene) {
    const auto helps = [](const Emitter& emitter) { return !emitter.isDelta() && !emitter.isInfinite(); };
    // The candidates that each has at least are then no more than the fewest paths of a pass.
    return scene.emitters.size() <= tuning::FewestPaths / tuning::Candidates &&
           std::any_of(scene.emitters.begin(), scene.emitters.end(), helps);
}

bool LightCaches::reflectedIn(const Scene& scene) {
    const auto glossy = [](const BsdfPtr& bsdf) { return reflectsSharply(bsdf->lobes()); };
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
        return std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(), glossy);
    });
}

void LightCaches::prepare(const Scene& scene, const TargetChoice& targets, const ProgressToken& watch,
                          Statistics& statistics) {
    vertices_.resize(scene.emitters.size());
    reflected_.resize(scene.emitters.size());
    if (!reflectedIn(scene)) return;
    flights_ = flightsIn(scene);
    for (size_t i = 0; i < reflected_.size(); ++i) {
        if (!(targets.probability(i) > 0.0f) || scene.emitters[i].isDelta()) continue;
        reflected_[i].prepare(scene, scene.emitters[i], flights_, watch);
        statistics.add(counter::LightPaths, tuning::MostPaths);
    }
}

void LightCaches::trace(const Scene& scene, const TargetChoice& targets, size_t guidedPaths, const PassInfo& pass,
                        Statistics& statistics) {
    const auto all = float(std::clamp(guidedPaths / 4, std::min(guidedPaths, tuning::FewestPaths), tuning::MostPaths));
    uint64_t paths = 0;
    for (size_t i = 0; i < vertices_.size(); ++i) {
        const EmitterChoice choice = targets.choice(i);
        if (!(choice.ofPath > 0.0f) || scene.emitters[i].isDelta()) continue;
        const Emitter& emitter = scene.emitters[i];
        const size_t share = size_t(all * choice.ofPath) + tuning::Candidates;
        vertices_[i].trace(scene, emitter, choice, share, pass);
        paths += share;
        if (reflected_[i].empty()) continue;
        reflected_[i].trace(scene, emitter, choice, share, pass, flights_);
        paths += share;
    }
    statistics.add(counter::LightPaths, paths);
    statistics.add("rays", paths);
}

} // namespace tungsten::path
