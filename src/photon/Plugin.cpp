// Registration of the photon-map integrators.

#include "photon/PhotonIntegrator.h"

#include "tungsten/integrator/Plugin.h"

namespace {

void add(tungsten::IntegratorRegistry& registry, const std::string& type, const std::string& description,
         bool progressive) {
    registry.add(type, description,
                 [progressive](std::shared_ptr<const tungsten::Scene> scene, const tungsten::ObjectReader& settings) {
                     return std::make_unique<tungsten::photon::PhotonIntegrator>(std::move(scene), settings,
                                                                                 progressive);
                 });
}

void registerIntegrators(tungsten::IntegratorRegistry& registry) {
    add(registry, "photon_map", "photon map, steady state", false);
    add(registry, "progressive_photon_map", "progressive photon map, steady state", true);
    add(registry, "transient_photon_map", "time-resolved photon map", false);
    add(registry, "progressive_transient_photon_map", "time-resolved progressive photon map", true);
}

} // namespace

extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
    static const tungsten::PluginDescriptor descriptor{tungsten::PluginAbi, "photon", registerIntegrators};
    return &descriptor;
}
