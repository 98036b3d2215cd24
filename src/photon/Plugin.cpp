// Registration of the photon-map integrators.

#include "photon/PhotonIntegrator.h"

#include "tungsten/integrator/Plugin.h"

namespace {

void add(tungsten::IntegratorRegistry& registry, const std::string& type, const std::string& description,
         bool progressive, tungsten::DefaultGate gate) {
    registry.add(type, description,
                 [progressive](std::shared_ptr<const tungsten::Scene> scene, const tungsten::ObjectReader& settings) {
                     return std::make_unique<tungsten::photon::PhotonIntegrator>(std::move(scene), settings,
                                                                                 progressive);
                 },
                 {gate, tungsten::IntegratorFamily::PhotonMaps, progressive && gate == tungsten::DefaultGate::Gated});
}

void registerIntegrators(tungsten::IntegratorRegistry& registry) {
    using tungsten::DefaultGate;
    add(registry, "photon_map", "photon map, steady state", false, DefaultGate::Never);
    add(registry, "progressive_photon_map", "progressive photon map, steady state", true, DefaultGate::Never);
    add(registry, "transient_photon_map", "time-resolved photon map", false, DefaultGate::Gated);
    add(registry, "progressive_transient_photon_map", "time-resolved progressive photon map", true, DefaultGate::Gated);
}

} // namespace

extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
    static const tungsten::PluginDescriptor descriptor{tungsten::PluginAbi, "photon", registerIntegrators};
    return &descriptor;
}
