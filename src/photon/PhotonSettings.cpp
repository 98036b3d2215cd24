#include "photon/PhotonSettings.h"

namespace tungsten::photon {

namespace {

constexpr double MostPhotons = 1e9;
constexpr float Unbounded = 1e30f;

void requirePoints(const ObjectReader& block) {
    const std::vector<std::string> later{"beams",        "planes", "planes_1d",     "volumes",
                                         "hypervolumes", "balls",  "volumes_balls", "mis_volumes_balls"};
    const std::string type = block.text("volume_photon_type", "points");
    if (type == "points") return;
    const bool known = std::find(later.begin(), later.end(), type) != later.end();
    block.problem("volume_photon_type", known ? "'" + type + "' is not supported; supported: points"
                                              : "expected points, found '" + type + "'");
}

} // namespace

PhotonSettings readPhotonSettings(const ObjectReader& block, const Scene& scene, bool progressive) {
    PhotonSettings settings;
    requirePoints(block);
    settings.progressive = progressive;
    settings.photonCount = uint64_t(block.integer("photon_count", 1000000, {1, MostPhotons}));
    settings.volumePhotonCount = uint64_t(block.integer("volume_photon_count", 1000000, {1, MostPhotons}));
    settings.gatherCount = uint32_t(block.integer("gather_photon_count", 20, {1, 1e9}));
    settings.gatherRadius = float(block.number("gather_radius", Unbounded, Range::positive()));
    settings.volumeRadius = float(block.number("volume_gather_radius", settings.gatherRadius, Range::positive()));
    settings.fixedVolumeRadius = block.flag("fixed_volume_radius", false);
    settings.lowOrderScattering = block.flag("low_order_scattering", true);
    settings.includeSurfaces = block.flag("include_surfaces", true);
    settings.alpha = float(block.number("alpha", 0.3, Range::unit()));
    settings.volumeAlpha = float(block.number("volume_alpha", double(settings.alpha), Range::unit()));
    if (settings.fixedVolumeRadius && settings.volumeRadius >= Unbounded)
        block.problem("volume_gather_radius",
                      "a fixed radius (fixed_volume_radius) needs a volume_gather_radius or gather_radius");
    if (scene.transport.gate.delta)
        block.problem("delta_time_gate",
                      "photon points meet a delta gate with probability zero; give the gate a width");
    settings.scheme = darts::readScheme(block);
    // Ways of building the published structures; the gathers here need no such choice.
    block.accept({"use_grid", "grid_memory", "use_frustum_grid", "exclude_non_mis", "strict_time_width",
                  "frustum_culling", "reuse_path_dir"});
    return settings;
}

} // namespace tungsten::photon
