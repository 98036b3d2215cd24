#include "path/PathSettings.h"

namespace tungsten::path {

PathSettings readPathSettings(const ObjectReader& block, const Scene& scene) {
    const bool timeResolved = !scene.transport.gate.steadyState;
    PathSettings settings;
    settings.lightSampling = block.flag("enable_light_sampling", true);
    settings.volumeLightSampling = block.flag("enable_volume_light_sampling", true);
    settings.lowOrderScattering = block.flag("low_order_scattering", true);
    settings.includeSurfaces = block.flag("include_surfaces", true);
    settings.russianRoulette = block.flag("enable_rr", !timeResolved);
    if (scene.transport.gate.delta)
        block.problem("delta_time_gate",
                      "a path tracer meets a delta gate with probability zero; give the gate a width");
    for (const char* guided : {"enable_guiding", "enable_elliptical"})
        if (block.flag(guided, false)) block.warn(guided, "the path tracer samples distances and directions plainly");
    for (const Emitter& emitter : scene.emitters)
        if (emitter.isDelta())
            block.warn("type",
                       "the emitter '" + emitter.name +
                           "' shines in a single direction, which a path tracer cannot find: it lights nothing");
    // Settings of the photon integrators: a scene may switch between them and this one by its type alone.
    block.accept({"photon_count", "volume_photon_count", "gather_photon_count", "gather_radius", "volume_gather_radius",
                  "volume_photon_type", "fixed_volume_radius", "alpha", "volume_alpha", "use_grid", "grid_memory",
                  "use_frustum_grid", "exclude_non_mis", "strict_time_width", "frustum_culling", "reuse_path_dir"});
    return settings;
}

} // namespace tungsten::path
