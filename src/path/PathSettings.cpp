#include "path/PathSettings.h"

#include "tungsten/integrator/SceneFacts.h"

#include <algorithm>

namespace tungsten::path {

namespace {

void warnAboutUnguided(const ObjectReader& block, const SceneFacts& facts, const PathSettings& settings) {
    if (!settings.policy.guides()) return;
    if (!facts.timeResolved) {
        if (block.has("darts")) block.warn("darts", "guides time-resolved renders only");
    } else if (!settings.lightSampling || !settings.volumeLightSampling) {
        block.warn(settings.lightSampling ? "enable_volume_light_sampling" : "enable_light_sampling",
                   "guided paths connect to emitters; without it paths are sampled plainly");
    }
}

/// A camera path meets such light with probability zero; it is found from the first vertex on. Places of detectors are
/// connected to that vertex.
void warnAboutSingleDirections(const ObjectReader& block, const Scene& scene, const SceneFacts& facts) {
    const bool detectors = scene.camera.detectors() != nullptr;
    if (detectors && !facts.specularCameraSubpaths) return;
    const auto laser = std::find_if(scene.emitters.begin(), scene.emitters.end(),
                                    [](const Emitter& emitter) { return emitter.isDelta(); });
    if (laser == scene.emitters.end()) return;
    const std::string name = laser->name.empty() ? "" : " of '" + laser->name + "'";
    block.diagnostics()->warnings.push_back(
        {block.diagnostics()->file, "primitives",
         std::string("paths miss what ") +
             (detectors ? "detectors see, in mirrors or through refraction," : "the camera sees") + " of the light" +
             name +
             " where it is scattered for the first time, as it shines in a single direction; photon maps "
             "show it"});
}

void warnAboutMissedLight(const ObjectReader& block, const MissedLight& missed) {
    const std::string remedy = missed.emitter->isDelta()
                                   ? "; photon maps show it"
                                   : "; photon maps show it, and paths meet lights that have an area";
    block.diagnostics()->warnings.push_back(
        {block.diagnostics()->file, missed.emitter->path, "paths miss " + missed.description() + remedy});
}

} // namespace

transport::BounceLimits readBounceLimits(const ObjectReader& block, const Scene& scene) {
    transport::BounceLimits limits(scene.transport);
    limits.lowOrderScattering = block.flag("low_order_scattering", true,
                                           {"none", "false: leaves out paths with exactly one scattering in a medium"});
    limits.includeSurfaces = block.flag(
        "include_surfaces", true, {"none", "false: leaves out what reaches surfaces without a scattering in a medium"});
    return limits;
}

bool readRussianRoulette(const ObjectReader& block, bool timeResolved) {
    return block.flag("enable_rr", !timeResolved, {"none", "Russian roulette", "true in steady state, else false"});
}

void acceptPhotonSettings(const ObjectReader& block) {
    block.accept({"photon_count", "volume_photon_count", "gather_photon_count", "gather_radius", "volume_gather_radius",
                  "volume_photon_type", "volume_photon_length", "fixed_volume_radius", "boundary_kernels", "alpha",
                  "volume_alpha", "use_grid", "grid_memory", "use_frustum_grid", "exclude_non_mis", "strict_time_width",
                  "frustum_culling", "reuse_path_dir"});
}

PathSettings readPathSettings(const ObjectReader& block, const Scene& scene) {
    PathSettings settings;
    const SceneFacts facts = analyseScene(scene);
    settings.lightSampling =
        block.flag("enable_light_sampling", true, {"none", "surface vertices connect to emitters"});
    settings.volumeLightSampling =
        block.flag("enable_volume_light_sampling", true, {"none", "medium vertices connect to emitters"});
    settings.limits = readBounceLimits(block, scene);
    settings.russianRoulette = readRussianRoulette(block, facts.timeResolved);
    settings.policy = transport::readPolicy(block);
    warnAboutUnguided(block, facts, settings);
    warnAboutSingleDirections(block, scene, facts);
    if (!block.describes()) settings.missed = findMissedLight(scene);
    if (settings.missed) warnAboutMissedLight(block, *settings.missed);
    acceptPhotonSettings(block);
    return settings;
}

} // namespace tungsten::path
