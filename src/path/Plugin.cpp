// Registration of the path tracers.

#include "path/PathTracer.h"

#include "tungsten/render/Plugin.h"

namespace {

void registerIntegrators(tungsten::IntegratorRegistry& registry) {
    const auto make = [](std::shared_ptr<const tungsten::Scene> scene, const tungsten::ObjectReader& settings) {
        return std::make_unique<tungsten::path::PathTracer>(std::move(scene), settings);
    };
    registry.add("path_tracer", "unbiased path tracing with next-event estimation, steady state or time-resolved",
                 make);
    registry.add("transient_path_tracer", "the same, always time-resolved", make);
}

} // namespace

extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
    static const tungsten::PluginDescriptor descriptor{tungsten::PluginAbi, "path", registerIntegrators};
    return &descriptor;
}
